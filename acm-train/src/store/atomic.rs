//! Files of a run folder, each written whole or not at all ([`acm_datasets::files::atomic`]).

use std::{io::Write, path::Path};

use acm_datasets::files::atomic::replace;

use super::error::StoreError;

/// Writes `bytes` to `path` atomically.
///
/// # Errors
/// The folder is missing, may not be written, or is full.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    replace(path, |file| file.write_all(bytes)).map_err(|source| StoreError::io("write", path, source))
}

/// Makes a folder and those above it, and writes their names to the disk.
///
/// # Errors
/// A folder cannot be made.
pub fn make_folder(path: &Path) -> Result<(), StoreError> {
    acm_datasets::files::atomic::make_folder(path).map_err(|source| StoreError::io("create", path, source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.json");
        write(&path, b"first, and longer").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write(Path::new("no/such/folder/a.json"), b"").unwrap_err();
        assert!(error.to_string().contains("no/such/folder/a.json"), "{error}");
        assert_eq!(error.exit_code(), 4);
    }
}
