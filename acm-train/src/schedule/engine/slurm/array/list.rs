//! The runs of one array: the run of each index, and all that a task needs, even if the files that were read at
//! submission change.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::digest::digest;
use crate::{
    run::record::FORMAT,
    schedule::open::{Asked, Run},
    store::{StoreError, hashed},
};

/// Contents of `slurm/0001.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct List {
    /// Version of this format.
    pub format: u32,
    /// Largest number of attempts at a run from the same epoch.
    pub attempts: usize,
    /// Folder of the data set's tables, where the command line named one.
    pub data: Option<PathBuf>,
    /// Configurations of the runs.
    pub asked: Vec<Asked>,
    /// The runs; the index of a task is a place in this list.
    pub runs: Vec<Entry>,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Name of the run in the folder.
    pub id: String,
    /// Index in [`List::asked`].
    pub asked: usize,
    /// The plan's name.
    pub plan: String,
    /// SHA-256 of its checkpoint as it was submitted; `None` where there was none.
    pub checkpoint: Option<String>,
}

impl Entry {
    /// Returns a run as it is now.
    ///
    /// # Errors
    /// Its checkpoint cannot be read.
    pub fn new(run: &Run) -> Result<Self, StoreError> {
        let Run { id, asked, plan, .. } = run.clone();
        Ok(Self { id, asked, plan, checkpoint: digest(&run.checkpoint)? })
    }
}

impl List {
    /// Reads a list.
    ///
    /// # Errors
    /// It cannot be read, is not a list, or is of a later version.
    pub fn read(file: &Path) -> Result<Self, StoreError> {
        hashed::read(file, FORMAT)
    }

    /// Writes it.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write(&self, file: &Path) -> Result<(), StoreError> {
        hashed::write(file, self)
    }
}
