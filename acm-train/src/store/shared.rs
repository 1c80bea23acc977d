//! A folder that several processes share, each with its own runs: they hold a shared lock, and an exclusive claim finds the
//! folder in use.

use std::path::Path;

use acm_datasets::files::atomic::sweep;
use acm_datasets::files::lock::{self, Lock};

use super::{
    atomic,
    claim::{LOCK, ensure_own_folder, in_use},
    error::StoreError,
};

/// Makes the folder if necessary, and takes a shared lock. The first process to lock it removes temporary files of killed
/// processes.
///
/// # Errors
/// Another process holds the folder exclusively, or it cannot be made or written, or it is something else.
pub fn join(root: &Path, inside: &[&str], mark: &str) -> Result<Lock, StoreError> {
    ensure_own_folder(root, mark)?;
    inside.iter().chain(&[""]).try_for_each(|folder| atomic::make_folder(&root.join(folder)))?;
    let path = root.join(LOCK);
    if let Ok(alone) = lock::take(&path) {
        inside.iter().chain(&[""]).try_for_each(|folder| sweep(&root.join(folder)))?;
        alone.open_up().map_err(|source| StoreError::io("lock", &path, source))?;
    }
    lock::share(&path).map_err(|refused| in_use(root, &path, refused))
}
