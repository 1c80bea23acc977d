//! Modes of sharing a folder, and the lock of each.

use std::path::Path;

use acm_datasets::lock::Lock;

use super::{claim::claim, error::StoreError, shared};

/// Modes of sharing a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Nobody.
    Alone {
        /// Whether to go on with what it holds.
        resume: bool,
    },
    /// Others that share it: each works on runs of its own.
    Shared,
    /// Anybody, since nothing is written.
    Look,
}

/// Holds a folder as asked; no lock where nothing is to be written.
pub(super) fn held(root: &Path, inside: &[&str], mark: &str, hold: Hold) -> Result<Option<Lock>, StoreError> {
    match hold {
        Hold::Alone { resume } => claim(root, inside, mark, resume).map(Some),
        Hold::Shared => shared::join(root, inside, mark).map(Some),
        Hold::Look => Ok(None),
    }
}
