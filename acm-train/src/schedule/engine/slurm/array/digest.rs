//! Digest of a checkpoint.

use std::path::Path;

use crate::store::{StoreError, hashed};

/// Returns the SHA-256 of a file, hex; `None` where there is none.
///
/// # Errors
/// It is there and cannot be read.
pub fn digest(file: &Path) -> Result<Option<String>, StoreError> {
    if file.exists() { hashed::of_file(file).map(Some) } else { Ok(None) }
}
