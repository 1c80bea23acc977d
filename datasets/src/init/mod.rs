//! A first manifest for a folder of recordings: recognized facts are written, the rest are questions in comments.
//!
//! ```text
//! files → Look of each column → groups with the same columns → sources and trials → part of each column → text
//! ```
//!
//! Which columns are commands and which are measured cannot be seen in their values: their names propose it, and the draft asks.

mod clocks;
mod column;
mod draft;
mod found;
mod look;
mod names;
mod signals;
mod sources;
mod time;

use std::path::Path;

use crate::error::DataError;

/// The text of a manifest for a folder, with questions as comments.
///
/// # Errors
/// The file system; a folder without recordings.
pub fn manifest(folder: &Path) -> Result<String, DataError> {
    let found = sources::folder(folder)?;
    if found.sources.is_empty() {
        let left: String = found.left.iter().take(3).map(|(path, reason)| format!("; {path}: {reason}")).collect();
        let more = found.left.len().saturating_sub(3);
        let more = if more > 0 { format!("; and {more} more files") } else { String::new() };
        return Err(DataError::Usage(format!("{}: no recordings can be read{left}{more}", folder.display())));
    }
    Ok(draft::text(folder, &found))
}
