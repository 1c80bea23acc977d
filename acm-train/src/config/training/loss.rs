//! Loss functions by name; the equations are in [`crate::learn::loss`].

use serde::{Deserialize, Serialize};

/// Loss function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// Mean square of the difference.
    MeanSquare,
    /// Cross-entropy of labels 0 and 1, each with a logit.
    CrossEntropy,
}
