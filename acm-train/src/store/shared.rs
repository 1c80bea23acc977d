//! A folder that several processes share, each at work on runs of its own: they hold its lock together, and whoever wants
//! the folder alone finds it in use.

use std::path::Path;

use acm_datasets::{
    atomic::sweep,
    lock::{self, Lock},
};

use super::{
    atomic,
    claim::{LOCK, ensure_own_folder, in_use},
    error::StoreError,
};

/// Makes the folder if need be, and joins whoever shares it. Who comes while nobody is there removes what killed processes
/// were writing.
///
/// # Errors
/// Somebody has the folder alone, or it cannot be made, written, or is something else.
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
