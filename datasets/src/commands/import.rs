//! `acm-data import`: a data set from what others have published.

use std::fmt::Write;
use std::path::Path;

use acm_datasets::{DataError, sources};

pub fn run(source: &str, clone: &Path, out: &Path, text: &mut String) -> Result<(), DataError> {
    let Some(format) = sources::ALL.iter().find(|s| s.name == source) else {
        let known: Vec<String> = sources::ALL.iter().map(|s| format!("  {}: {}", s.name, s.about)).collect();
        return Err(DataError::Usage(format!("unknown source {source:?}; known sources:\n{}", known.join("\n"))));
    };
    for (file, rows) in (format.import)(clone, out)? {
        let _ = writeln!(text, "{}: {rows} rows", out.join(file).display());
    }
    super::next(text, "acm-data", "check", out, "");
    Ok(())
}
