//! `training.output_layer`: what a network says before it has learned anything.

use serde::{Deserialize, Serialize};

/// First values of the output layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutputLayer {
    /// Zero. Epoch 0 is then the nominal model itself, and a candidate for the best epoch; what is learned is scaled by a
    /// factor in [0, 1] from the validation part.
    Zero,
    /// Those of `torch.nn.Linear`. There is no epoch 0, and the factor is 1.
    Random,
}
