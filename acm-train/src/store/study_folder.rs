//! Folder of a study, with a run folder for each experiment.

use std::path::{Path, PathBuf};

use acm_datasets::files::lock::Lock;

use super::{
    error::StoreError,
    hold::{Hold, held},
};

/// The claimed folder of a study, which holds a run folder for each experiment. Dropping it releases the lock.
#[derive(Debug)]
pub struct StudyFolder {
    root: PathBuf,
    _lock: Option<Lock>,
}

impl StudyFolder {
    /// Makes the folder if need be, and claims it for this process.
    ///
    /// # Errors
    /// As [`super::RunFolder::claim`].
    pub fn hold(root: &Path, hold: Hold) -> Result<Self, StoreError> {
        let lock = held(root, &["runs"], "study.json", hold)?;
        Ok(Self { root: root.into(), _lock: lock })
    }

    /// Returns a file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }
}
