//! Errors of an export.

use acm_stream::{AverageError, PartsError, StepError};
use thiserror::Error;

/// Reasons why an export is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The parts make no estimator.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// The parts make no average.
    #[error(transparent)]
    Average(#[from] AverageError),
    /// A name that no program could use.
    #[error(
        "{name:?} is no name for files and functions; use a lower-case letter, then letters, digits and underscores, 40 at most"
    )]
    Name {
        /// Name as given.
        name: String,
    },
    /// The export cannot write a part of the estimator.
    #[error("{what} cannot be written as {format}; {remedy}")]
    Unsupported {
        /// Name of the part.
        what: String,
        /// Format of the export.
        format: &'static str,
        /// Alternative.
        remedy: String,
    },
    /// The estimator refused a sample of the recorded vectors.
    #[error(
        "the estimator refused sample {sample} of its own self-test: {error}; its values lead beyond what numbers hold"
    )]
    Rehearsal {
        /// Index of the sample, counted from 0.
        sample: usize,
        /// Error of the estimator.
        error: StepError,
    },
    /// A number that is not finite.
    #[error("the estimator cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// Parameters that make no file.
    #[error("the parameters cannot be written: {0}")]
    Tensors(#[from] safetensors::SafeTensorError),
}
