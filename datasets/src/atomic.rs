//! Files that are either complete or not there.
//!
//! The content goes to a temporary file in the same folder, is flushed to the disk, and takes its name in one step; a
//! crash, a full disk or Ctrl-C leaves the old file, or none.

use std::io::Write;
use std::path::Path;

use crate::error::DataError;

/// Writes `path` in one step; `fill` writes the content.
///
/// # Errors
/// What the file system says, with the path.
pub fn write(path: &Path, fill: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>) -> Result<(), DataError> {
    let failed = |e: std::io::Error| DataError::file_system("write", path, &e);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(|e| DataError::file_system("create", folder, &e))?;
    let mut file = tempfile::Builder::new().prefix(".writing-").tempfile_in(folder).map_err(failed)?;
    fill(file.as_file_mut()).map_err(failed)?;
    file.as_file_mut().flush().map_err(failed)?;
    readable(file.as_file()).map_err(failed)?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    // the new name is on the disk only once the folder is
    #[cfg(unix)]
    std::fs::File::open(folder).and_then(|f| f.sync_all()).map_err(failed)?;
    Ok(())
}

/// Writes `bytes` to `path` in one step.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    write(path, |file| file.write_all(bytes))
}

/// Temporary files are private; results are for everybody who may read the folder.
#[cfg(unix)]
fn readable(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable(_: &std::fs::File) -> std::io::Result<()> {
    Ok(())
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
}
