//! Result of one epoch, a row of a record.

use serde::{Deserialize, Serialize};

/// One epoch of training; of a baseline, one penalty or one round. Losses are mean squared errors of the standardised residual.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Number of the epoch, from 1.
    pub epoch: usize,
    /// Learning rate of its steps; of a ridge regression, the penalty.
    pub learning_rate: f64,
    /// Mean over the training windows, as they were met.
    pub train_loss: f64,
    /// Mean over the validation windows, after the epoch.
    pub validation_loss: f64,
}
