//! Parts as a file: JSON that carries its own SHA-256, so that a robot's program never runs with a bit that has changed.

use thiserror::Error;

use crate::parts::Parts;

/// Why the bytes of a file are no parts.
#[derive(Debug, Error)]
pub enum SavedError {
    /// They are not what was written.
    #[error("{0}; write it again with `acm-eval stream RUN --save FILE`")]
    Broken(#[from] acm_hashed::Broken),
    /// They are what was written, and something else than parts.
    #[error("it holds no estimator ({0}); write one with `acm-eval stream RUN --save FILE`")]
    Json(#[from] serde_json::Error),
}

impl Parts {
    /// The bytes of a file, with every bit of the numbers.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn to_json(&self) -> serde_json::Result<Vec<u8>> {
        acm_hashed::encode(self)
    }

    /// Reads the bytes that [`Parts::to_json`] wrote, and checks their SHA-256.
    ///
    /// # Errors
    /// The bytes were changed, or are of something else.
    pub fn from_json(bytes: &[u8]) -> Result<Self, SavedError> {
        Ok(serde_json::from_str(&acm_hashed::verify(bytes)?)?)
    }
}
