//! Attempts of a run, and how they ended.
//!
//! A run that goes on from a later epoch than before has not failed: only what was begun from the same checkpoint as now
//! counts, so that a run that is cut off by its time limit again and again comes to its end.

use serde::{Deserialize, Serialize};

use super::folder::SlurmFolder;
use crate::{
    run::record::FORMAT,
    store::{StoreError, hashed},
};

/// Contents of `slurm/tries/<run>.json`: the attempts at a run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Tries {
    /// Version of this format.
    pub format: u32,
    /// The first first.
    pub tries: Vec<Try>,
}

/// One attempt at a run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Try {
    /// Slurm's name for the task: `12_3`.
    pub task: String,
    /// Name of the machine.
    pub node: Option<String>,
    /// SHA-256 of the checkpoint that it began from.
    pub checkpoint: Option<String>,
    /// End of the attempt; `None` where it was killed, or is running.
    pub end: Option<End>,
}

/// End of an attempt.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct End {
    /// Exit code.
    pub code: u8,
    /// Error message of the run.
    pub said: String,
}

impl Tries {
    /// Reads the attempts at a run.
    ///
    /// # Errors
    /// There is a file, and it cannot be read.
    pub fn read(folder: &SlurmFolder, id: &str) -> Result<Self, StoreError> {
        let path = folder.tries(id, "json");
        if path.exists() { hashed::read(&path, FORMAT) } else { Ok(Self { format: FORMAT, tries: vec![] }) }
    }

    /// Writes the attempts; the caller must hold the run's lock.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write(&self, folder: &SlurmFolder, id: &str) -> Result<(), StoreError> {
        hashed::write(&folder.tries(id, "json"), self)
    }

    /// Returns the number of attempts that began from this checkpoint.
    pub fn from(&self, checkpoint: &Option<String>) -> usize {
        self.tries.iter().filter(|one| one.checkpoint == *checkpoint).count()
    }
}
