//! Errors between the data and the record of a run.

use acm_core::CalibrationError;
use acm_datasets::DataError;
use miette::Diagnostic;
use thiserror::Error;

use crate::{
    config::{Complaint, ConfigError, DeviceError},
    learn::LearnError,
    store::{StoreError, rises},
};

/// Reasons why a run ends without a record. Each message names the file, the value and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum RunError {
    /// A file or a folder cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Store(#[from] StoreError),

    /// The experiment asks for something that the data do not have.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Config(#[from] ConfigError),

    /// The network cannot be fitted.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Learn(#[from] LearnError),

    /// The data set cannot be used.
    #[error(transparent)]
    Data(#[from] DataError),

    /// The data set can be read, but not used for this experiment.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Unusable {
        /// Part of the data, and why it cannot be used.
        what: String,
        /// Advice to the user.
        help: String,
    },

    /// The nominal model cannot be calibrated on these data.
    #[error("the nominal model cannot be calibrated on trials {trials}: {source}")]
    #[diagnostic(help(
        "choose another [nominal] model in the experiment file (strain, polynomial, none), or give more calibration trials"
    ))]
    Calibration {
        /// Trials calibrated on.
        trials: String,
        /// Reason of the failure.
        source: CalibrationError,
    },

    /// Signals cannot be received, so that the run could not be stopped.
    #[error("cannot listen to Ctrl-C: {0}")]
    #[diagnostic(help("start acm-train as a process of its own"))]
    Signals(ctrlc::Error),
}

rises!(Box<Complaint>, DeviceError => ConfigError => RunError);

impl RunError {
    /// Returns the exit code: 2 usage and configuration, 3 data, 4 file system, 5 in use.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Signals(_) => 2,
            Self::Unusable { .. } | Self::Calibration { .. } => 3,
            Self::Store(error) => error.exit_code(),
            Self::Config(error) => error.exit_code(),
            Self::Learn(error) => error.exit_code(),
            Self::Data(error) => error.exit_code(),
        }
    }
}
