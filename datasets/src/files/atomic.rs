//! Atomic writes: a file is either complete or absent.
//!
//! The content goes to a temporary file in the same folder, is flushed to the disk, and takes its name in one step; a
//! crash, a full disk or Ctrl-C leaves the old file, or none.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use crate::error::DataError;

/// Names of files that are being written begin so; a killed process leaves one behind.
pub const DRAFT_PREFIX: &str = ".writing-";

/// Writes `path` in one step; `fill` writes the content. The folder is made where it is missing.
///
/// # Errors
/// What the file system says, with the path.
pub fn write(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), DataError> {
    let folder = folder_of(path);
    make_folder(folder).map_err(|e| DataError::file_system("create", folder, &e))?;
    replace(path, fill).map_err(|e| DataError::file_system("write", path, &e))
}

/// As [`write()`], in a folder that is there, for callers with errors of their own.
///
/// # Errors
/// What the file system says.
pub fn replace(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let folder = folder_of(path);
    let mut draft = drafts().tempfile_in(folder)?;
    fill(draft.as_file_mut())?;
    draft.as_file_mut().flush()?;
    draft.as_file().sync_all()?;
    draft.persist(path).map_err(|refused| refused.error)?;
    flush(folder)
}

/// Makes a folder and those above it, and puts their names on the disk.
///
/// # Errors
/// What the file system says.
pub fn make_folder(path: &Path) -> io::Result<()> {
    let missing: Vec<&Path> =
        path.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists()).collect();
    std::fs::create_dir_all(path)?;
    missing.into_iter().try_for_each(|folder| flush(folder_of(folder)))
}

/// Removes what a killed process was writing in `folder`; the caller must hold the folder's [lock](crate::files::lock).
///
/// # Errors
/// What the file system says, of the file that cannot be removed.
pub fn sweep(folder: &Path) -> Result<(), DataError> {
    let refuse = |error| DataError::file_system("read", folder, &error);
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let entry = entry.map_err(refuse)?;
        if entry.file_name().to_string_lossy().starts_with(DRAFT_PREFIX) {
            std::fs::remove_file(entry.path())
                .map_err(|error| DataError::file_system("remove", entry.path(), &error))?;
        }
    }
    Ok(())
}

/// Puts the names in a folder on the disk.
///
/// # Errors
/// The disk fails. A file system that cannot flush folders, and a folder that may not be opened, have no better to offer.
pub fn flush(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if !CANNOT.contains(&error.kind()) => Err(error),
        _ => Ok(()),
    }
}

/// Errors of file systems that cannot flush folders.
const CANNOT: [io::ErrorKind; 3] =
    [io::ErrorKind::Unsupported, io::ErrorKind::InvalidInput, io::ErrorKind::PermissionDenied];

/// Temporary files are private; results are readable as the folder is.
fn drafts() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(DRAFT_PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Writes `bytes` to `path` in one step.
///
/// # Errors
/// As [`write()`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    write(path, |file| file.write_all(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_that_fails_leaves_the_old_file_and_nothing_else() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a/table.csv");
        write_bytes(&path, b"old")?;
        let failure = write(&path, |file| {
            file.write_all(b"half")?;
            Err(std::io::Error::from(std::io::ErrorKind::StorageFull))
        });
        let error = failure.err().ok_or("the write succeeded")?;
        assert_eq!(error.exit_code(), 4);
        assert!(error.to_string().contains("table.csv") && error.to_string().contains("make room"), "{error}");
        assert_eq!(std::fs::read(&path)?, b"old");
        assert_eq!(std::fs::read_dir(folder.path().join("a"))?.count(), 1);
        Ok(())
    }

    #[test]
    fn what_a_killed_process_was_writing_is_swept_away() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let draft = folder.path().join(format!("{DRAFT_PREFIX}abc123"));
        std::fs::write(&draft, b"half")?;
        std::fs::write(folder.path().join("record.json"), b"whole")?;
        sweep(folder.path())?;
        assert!(!draft.exists() && folder.path().join("record.json").exists());
        Ok(())
    }
}
