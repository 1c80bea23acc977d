//! Manifests of data sets that the program writes: it replaces its own, and never somebody's recordings.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use super::Manifest;
use crate::error::DataError;
use crate::files::{atomic, owned};

/// Kinds of files that sets consist of.
const KINDS: [&str; 4] = ["csv", "json", "parquet", "txt"];

/// Refuses a folder whose manifest does not begin with `head`, and one that has no manifest and holds tables.
///
/// # Errors
/// Such a folder, or one that cannot be read.
pub fn claim(folder: &Path, head: &str) -> Result<(), DataError> {
    let manifest = folder.join("manifest.toml");
    owned::claim(&manifest, |text| text.starts_with(head.as_bytes()))?;
    let table = |path: &Path| path.extension().and_then(OsStr::to_str).is_some_and(|kind| KINDS.contains(&kind));
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    match entries.filter(|path| table(path)).min() {
        Some(path) if !manifest.exists() => owned::claim(&path, |_| false),
        _ => Ok(()),
    }
}

/// Writes `folder/manifest.toml` below `head`, a comment that tells whose it is.
///
/// # Errors
/// The file system.
pub fn write(manifest: &Manifest, folder: &Path, head: &str) -> Result<(), DataError> {
    let text = toml::to_string(manifest);
    let text = text.map_err(|e| DataError::Usage(format!("the manifest cannot be written: {e}")))?;
    atomic::write_bytes(&folder.join("manifest.toml"), format!("{head}\n{text}").as_bytes())
}
