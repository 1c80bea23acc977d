//! `training.output_layer`: whether the nominal model is a candidate for the best epoch.

use serde::{Deserialize, Serialize};

/// Initial output layer, at epoch 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutputLayer {
    /// Zeros. Epoch 0 is then the nominal model itself, and a candidate for the best epoch; the correction is scaled by
    /// a factor in [0, 1] from the validation part. Training starts from torch's values nevertheless.
    Zero,
    /// Values of `torch.nn.Linear`, whose predictions are of no use: there is no epoch 0, and the factor is 1.
    Random,
}
