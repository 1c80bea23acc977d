//! Files and folders as they are read.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// Reasons why the structure cannot be read.
#[derive(Debug)]
pub enum StructureError {
    /// A file or folder that cannot be read.
    Read { path: PathBuf, source: std::io::Error },
    /// A file that is no Rust.
    Parse { path: PathBuf, source: syn::Error },
}

impl fmt::Display for StructureError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Read { path, source } => write!(f, "{} cannot be read: {source}", path.display()),
            Self::Parse { path, source } => write!(f, "{} is no Rust: {source}", path.display()),
        }
    }
}

/// Returns the entries of a folder, in order.
pub fn entries(folder: &Path) -> Result<Vec<PathBuf>, StructureError> {
    let fail = |source| StructureError::Read { path: folder.into(), source };
    let found: Result<Vec<PathBuf>, _> = fs::read_dir(folder).map_err(fail)?.map(|entry| Ok(entry?.path())).collect();
    let mut found = found.map_err(fail)?;
    found.sort();
    Ok(found)
}

/// Returns the text of a file.
pub fn read(path: &Path) -> Result<String, StructureError> {
    fs::read_to_string(path).map_err(|source| StructureError::Read { path: path.into(), source })
}

/// Returns whether a file is Rust.
pub fn is_rust(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "rs")
}
