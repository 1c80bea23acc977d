//! Files of a run folder, each written whole or not at all ([`acm_datasets::atomic`]), and the drafts of a killed run.

use std::{fs, io::Write, path::Path};

use acm_datasets::atomic::{DRAFT_PREFIX, replace};

use crate::error::TrainError;

/// Puts `bytes` at `path`, all or nothing.
///
/// # Errors
/// The folder is missing, may not be written, or is full.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), TrainError> {
    replace(path, |file| file.write_all(bytes)).map_err(|source| TrainError::io("write", path, source))
}

/// Makes a folder and those above it, whose names are then on the disk.
///
/// # Errors
/// A folder cannot be made.
pub fn make_folder(path: &Path) -> Result<(), TrainError> {
    acm_datasets::atomic::make_folder(path).map_err(|source| TrainError::io("create", path, source))
}

/// Removes what a killed process was writing in `folder`; whoever calls this holds the folder's lock.
///
/// # Errors
/// The folder cannot be read, or a file not removed.
pub fn sweep(folder: &Path) -> Result<(), TrainError> {
    let refuse = |source| TrainError::io("read", folder, source);
    for entry in fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(DRAFT_PREFIX)) {
            fs::remove_file(&path).map_err(|source| TrainError::io("remove", &path, source))?;
        }
    }
    Ok(())
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
    fn what_a_killed_process_was_writing_is_swept_away() {
        let folder = tempfile::tempdir().unwrap();
        let draft = folder.path().join(format!("{DRAFT_PREFIX}abc123"));
        fs::write(&draft, b"half").unwrap();
        fs::write(folder.path().join("record.json"), b"whole").unwrap();
        sweep(folder.path()).unwrap();
        assert!(!draft.exists() && folder.path().join("record.json").exists());
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = write(Path::new("no/such/folder/a.json"), b"").unwrap_err();
        assert!(error.to_string().contains("no/such/folder/a.json"), "{error}");
        assert_eq!(error.exit_code(), 4);
    }
}
