//! Modes of sharing a folder, and the lock of each.

use std::path::Path;

use acm_datasets::files::lock::Lock;

use super::{claim::claim, error::StoreError, shared};

/// Modes of sharing a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Exclusive use.
    Alone {
        /// Whether to continue the runs that it holds.
        resume: bool,
    },
    /// Shared use: each process works on its own runs.
    Shared,
    /// No lock, since nothing is written.
    Look,
}

/// Locks a folder as requested; no lock where nothing is to be written.
pub(super) fn held(root: &Path, inside: &[&str], mark: &str, hold: Hold) -> Result<Option<Lock>, StoreError> {
    match hold {
        Hold::Alone { resume } => claim(root, inside, mark, resume).map(Some),
        Hold::Shared => shared::join(root, inside, mark).map(Some),
        Hold::Look => Ok(None),
    }
}
