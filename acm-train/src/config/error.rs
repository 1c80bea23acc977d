//! Errors of an experiment file.

use acm_models::DeviceError;
use miette::Diagnostic;
use thiserror::Error;

use super::parse::complaint::Complaint;

/// An experiment file, or a `--set`, that cannot be followed. Each message names the place, the value and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum ConfigError {
    /// The experiment has a fault.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Experiment(#[from] Box<Complaint>),

    /// The file cannot be read.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Unreadable {
        /// File and reason.
        what: String,
        /// Advice to the user.
        help: String,
    },

    /// The experiment names a device that is not there.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl ConfigError {
    /// Returns the exit code: 2, whatever it is.
    pub fn exit_code(&self) -> u8 {
        2
    }
}
