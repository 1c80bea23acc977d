//! Errors of a fit.

use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use super::fit::not_finite::NotFinite;
use super::import::ImportError;
use crate::store::StoreError;

/// Reasons why a fit ends early. Each message says what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum LearnError {
    /// The loss or its gradient is not finite.
    #[error("{0}")]
    NotFinite(Box<NotFinite>),

    /// A part has no windows.
    #[error(
        "the {part} part has no windows; shorten windows.length and windows.reach, or give it trials with longer \
         stretches between gaps"
    )]
    NoWindows {
        /// Name of the part: `training` or `validation`.
        part: &'static str,
    },

    /// The target is constant: there is nothing to learn.
    #[error(
        "the target is constant over the training part ({trials}): {outputs}; check what is measured there, or the \
         [nominal] model that brings it already"
    )]
    ConstantTarget {
        /// Trials of the part.
        trials: String,
        /// Each output and its value.
        outputs: String,
    },

    /// A file is not the network that it is declared to be.
    #[error("{file} is not this network: {error}")]
    Import {
        /// Name of the file.
        file: String,
        /// Mismatch between the file and the network.
        error: ImportError,
    },

    /// A network that was trained elsewhere, and is not here.
    #[error(
        "the network of this run came from {file}, and its checkpoint is missing; bring the checkpoint back, or import the \
         file again with `acm-eval import`"
    )]
    NotTrainedHere {
        /// Name of the file that it came from.
        file: String,
    },

    /// A baseline cannot be fitted to these numbers.
    #[error("{0}")]
    Baseline(String),

    /// The file is no checkpoint, or not the one that was written.
    #[error("{path} is damaged or no checkpoint: {why}; delete it, and the run starts from its first epoch")]
    Damaged {
        /// Path of the checkpoint.
        path: PathBuf,
        /// Reason why it cannot be used.
        why: String,
    },

    /// The checkpoint is of another run.
    #[error(
        "{path} is the checkpoint of another run: {differences}; go on with the settings and data that it was written \
         with, or delete it to start anew"
    )]
    Another {
        /// Path of the checkpoint.
        path: PathBuf,
        /// Each setting that differs, with both values.
        differences: String,
    },

    /// The file system refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Store(#[from] StoreError),

    /// The restored weights do not give the loss that was noted for them: a fault of the machine or of this program.
    #[error(
        "the weights of epoch {epoch} give a validation loss of {found:e} instead of {noted:e}; run again, and report \
         it if it happens twice"
    )]
    BestNotReproduced {
        /// The best epoch.
        epoch: usize,
        /// Loss noted during training.
        noted: f64,
        /// Loss of the restored weights.
        found: f64,
    },
}

impl LearnError {
    /// Adds the name of the run.
    pub fn in_run(self, run: &str) -> Self {
        match self {
            Self::NotFinite(found) => Self::NotFinite(Box::new(NotFinite { run: run.into(), ..*found })),
            other => other,
        }
    }

    /// Returns the exit code: 2 configuration, 3 data, 4 file system.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Baseline(_) | Self::Another { .. } | Self::NotTrainedHere { .. } => 2,
            Self::NotFinite(_) | Self::NoWindows { .. } | Self::ConstantTarget { .. } | Self::Import { .. } => 3,
            Self::Damaged { .. } | Self::BestNotReproduced { .. } => 4,
            Self::Store(error) => error.exit_code(),
        }
    }
}
