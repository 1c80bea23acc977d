//! Parts as a JSON file with its SHA-256, so that a robot's program never runs with a changed bit.

use thiserror::Error;

use crate::parts::Parts;

/// Reasons why the bytes of a file are refused.
#[derive(Debug, Error)]
pub enum SavedError {
    /// The hash is missing or does not match.
    #[error("{0}; write it again with `acm-eval stream RUN --save FILE`")]
    Broken(#[from] acm_hashed::Broken),
    /// The file is intact, but holds no parts.
    #[error("it holds no estimator ({0}); write one with `acm-eval stream RUN --save FILE`")]
    Json(#[from] serde_json::Error),
}

impl Parts {
    /// Returns the bytes of a JSON file with its SHA-256; numbers keep every bit.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn to_json(&self) -> serde_json::Result<Vec<u8>> {
        acm_hashed::encode(self)
    }

    /// Reads the bytes that [`Parts::to_json`] wrote, and checks their SHA-256.
    ///
    /// # Errors
    /// The bytes were changed, or are no parts.
    pub fn from_json(bytes: &[u8]) -> Result<Self, SavedError> {
        Ok(serde_json::from_str(&acm_hashed::verify(bytes)?)?)
    }
}
