//! `acm-data init`: a first manifest, with questions as comments.

use std::fmt::Write;
use std::path::Path;

use acm_datasets::files::atomic;
use acm_datasets::text::hint::command;
use acm_datasets::{DataError, init};

pub fn run(folder: &Path, text: &mut String) -> Result<(), DataError> {
    let path = folder.join("manifest.toml");
    if path.exists() {
        let check = command("acm-data", "check", folder, "");
        let message = format!("{}: there is a manifest already; move it away, or run {check}", path.display());
        return Err(DataError::Usage(message));
    }
    let draft = init::manifest(folder)?;
    atomic::write_bytes(&path, draft.as_bytes())?;
    let _ = writeln!(text, "{draft}\nwritten to {}: answer the questions in it", path.display());
    super::next(text, "acm-data", "check", folder, "");
    Ok(())
}
