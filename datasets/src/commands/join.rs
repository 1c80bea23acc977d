//! `acm-data join`: the trials of several sources as plain tables.

use std::fmt::Write;
use std::path::Path;

use acm_datasets::{DataError, join};

use crate::Set;

pub fn run(set: &Set, out: &Path, text: &mut String) -> Result<(), DataError> {
    let data = super::open(set, None)?;
    acm_datasets::describe::recognised(&data, text);
    for (file, rows) in join::write(&data, out)? {
        let _ = writeln!(text, "{}: {rows} rows", out.join(file).display());
    }
    super::next(text, "acm-data", "check", out, "");
    Ok(())
}
