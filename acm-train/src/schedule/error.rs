//! Errors of planning, running and collecting many runs.

use std::path::PathBuf;

use acm_datasets::DataError;
use miette::Diagnostic;
use thiserror::Error;

use super::engine::slurm::commands::SlurmError;
use crate::{
    config::{Complaint, ConfigError},
    learn::LearnError,
    run::RunError,
    store::{StoreError, rises},
};

/// Reasons why a job ends without its table; finished runs are kept.
#[derive(Debug, Error, Diagnostic)]
pub enum ScheduleError {
    /// A run or its preparation fails.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Run(#[from] RunError),

    /// A program of Slurm fails.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Slurm(#[from] SlurmError),

    /// The request is impossible.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Usage {
        /// The request, and why it is refused.
        what: String,
        /// Advice to the user.
        help: String,
    },

    /// The user stopped the job, after the checkpoint was written.
    #[error("stopped; {finished} of {planned} runs are finished and the rest are checkpointed in {}", folder.display())]
    #[diagnostic(help("continue where it stopped: the same command with --resume"))]
    Stopped {
        /// The run folder.
        folder: PathBuf,
        /// Runs with a record.
        finished: usize,
        /// Runs that the experiment asks for.
        planned: usize,
    },
}

rises!(StoreError, ConfigError, Box<Complaint>, LearnError, DataError => RunError => ScheduleError);

impl ScheduleError {
    /// Returns the exit code: those of a run, of Slurm, 2 usage, 130 stopped.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage { .. } => 2,
            Self::Run(error) => error.exit_code(),
            Self::Slurm(error) => error.exit_code(),
            Self::Stopped { .. } => 130,
        }
    }
}
