//! Optimizers: the `optimizer` of `[training]`.

use serde::{Deserialize, Serialize};

/// The rule that turns gradients into steps, with torch's semantics and defaults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OptimizerKind {
    /// Adam, weight decay added to the gradient (L2).
    Adam,
    /// Adam, weight decay apart from the gradient.
    Adamw,
    /// RMSprop without momentum.
    Rmsprop,
}

impl OptimizerKind {
    /// Returns torch's default weight decay.
    pub fn default_weight_decay(self) -> f64 {
        match self {
            Self::Adamw => 0.01,
            Self::Adam | Self::Rmsprop => 0.0,
        }
    }
}
