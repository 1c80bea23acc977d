//! Errors of an experiment file.

use miette::Diagnostic;
use thiserror::Error;

use super::{complaint::Complaint, device::DeviceError};

/// An experiment file, or a `--set`, that cannot be followed. Each message names the place, the value and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum ConfigError {
    /// It asks for something that cannot be.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Experiment(#[from] Box<Complaint>),

    /// It cannot be read.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Unreadable {
        /// Which file, and why not.
        what: String,
        /// Remedy.
        help: String,
    },

    /// It names a device that is not there.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl ConfigError {
    /// The exit code: 2, whatever it is.
    pub fn exit_code(&self) -> u8 {
        2
    }
}
