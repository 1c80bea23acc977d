//! Manifests of data sets that the program writes: it replaces its own, and never somebody's recordings.

use std::io::ErrorKind;
use std::path::Path;

use super::Manifest;
use crate::error::DataError;
use crate::files::{atomic, regular};

/// Refuses a folder whose manifest does not begin with `head`.
///
/// # Errors
/// Such a folder, or one that cannot be read.
pub fn claim(folder: &Path, head: &str) -> Result<(), DataError> {
    let manifest = folder.join("manifest.toml");
    match regular::read(&manifest) {
        Ok(text) if text.starts_with(head.as_bytes()) => Ok(()),
        Ok(_) => Err(DataError::Usage(format!(
            "{} holds a data set of its own, which would be lost; name another folder with --out DIR",
            folder.display()
        ))),
        Err(error) if error.kind() == ErrorKind::NotFound || error.kind() == ErrorKind::NotADirectory => Ok(()),
        Err(error) => Err(DataError::file_system("read", &manifest, &error)),
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
