//! Exclusive claim of a folder, by a lock that the operating system releases when the process ends.

use std::{fs, path::Path};

use acm_datasets::files::atomic::sweep;
use acm_datasets::files::lock::{self, Lock, Refused};

use super::{atomic, error::StoreError};

/// The lock of a folder.
pub(super) const LOCK: &str = ".lock";

/// Makes a folder, locks it, and makes the folders `inside`; `mark` is the file that shows that it was used before.
pub(crate) fn claim(root: &Path, inside: &[&str], mark: &str, resume: bool) -> Result<Lock, StoreError> {
    ensure_own_folder(root, mark)?;
    atomic::make_folder(root)?;
    let path = root.join(LOCK);
    let lock = lock::take(&path).map_err(|refused| in_use(root, &path, refused))?;
    for folder in inside {
        atomic::make_folder(&root.join(folder))?;
    }
    for folder in std::iter::once(&"").chain(inside) {
        sweep(&root.join(folder))?;
    }
    if !resume && root.join(mark).exists() {
        return Err(StoreError::Folder {
            what: format!("{} already holds a run", root.display()),
            help: "add --resume to continue it, or give this run a folder of its own with --out DIR".into(),
        });
    }
    Ok(lock)
}

/// Returns the error for the lock at `path` that was refused.
pub(crate) fn in_use(folder: &Path, path: &Path, refused: Refused) -> StoreError {
    match refused {
        Refused::Held(holder) => StoreError::InUse { folder: folder.into(), holder },
        Refused::Io(source) => StoreError::io("lock", path, source),
    }
}

/// Refuses a folder that has files but neither a lock nor its mark: it was not made by this program.
pub(super) fn ensure_own_folder(root: &Path, mark: &str) -> Result<(), StoreError> {
    if !root.is_dir() || root.join(LOCK).exists() || root.join(mark).exists() {
        return Ok(());
    }
    let mut entries = fs::read_dir(root).map_err(|source| StoreError::io("read", root, source))?;
    // Somebody else may have begun here since.
    let foreign = |entry: fs::DirEntry| entry.file_name() != LOCK && !root.join(LOCK).exists();
    match entries.any(|entry| entry.is_ok_and(foreign)) {
        false => Ok(()),
        true => Err(StoreError::Folder {
            what: format!("{} is not empty, and is not a run folder", root.display()),
            help: "give this run a folder of its own with --out DIR".into(),
        }),
    }
}
