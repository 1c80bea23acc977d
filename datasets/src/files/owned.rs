//! A command replaces only files that it wrote itself.

use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::Path;

use crate::error::DataError;

/// First bytes by which a command recognises its own files.
const HEAD: u64 = 4096;

/// Refuses a path at which there is something that the command did not write: `is_own` looks at the first bytes of a file. An empty file
/// has nothing to lose.
///
/// # Errors
/// Such a path; a file that cannot be read.
pub fn claim(path: &Path, is_own: impl Fn(&[u8]) -> bool) -> Result<(), DataError> {
    let mut head = Vec::new();
    let found = fs::metadata(path).and_then(|found| match found.is_file() {
        true => File::open(path)?.take(HEAD).read_to_end(&mut head).map(|_| true),
        false => Ok(false),
    });
    let what = match found {
        Err(error) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) => return Ok(()),
        Err(error) => return Err(DataError::file_system("read", path, &error)),
        Ok(true) if head.is_empty() || is_own(&head) => return Ok(()),
        Ok(true) => "this command did not write this file, which would be lost",
        Ok(false) => "this exists, and is not a file",
    };
    Err(DataError::Usage(format!("{}: {what}; give another name or folder, or move it away", path.display())))
}
