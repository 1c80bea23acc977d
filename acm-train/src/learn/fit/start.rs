//! Epoch 0: a network that adds nothing.
//!
//! ```text
//! W_head = 0        b_head = −m / s
//! ```
//!
//! | symbol | meaning                                        | shape | unit |
//! | ------ | ---------------------------------------------- | ----- | ---- |
//! | `m, s` | mean and spread of the targets in training     | [O]   | m    |
//!
//! It is a candidate for the best epoch, and steps do not start from it: behind an output layer of zeros the hidden layers
//! have no gradient at first, and a recurrent network then ends at another minimum (GRU on the trunk, five seeds, validation:
//! 14.01 ± 0.69 mm from zeros, 13.32 ± 0.44 mm from torch's values; the flight campaign does not tell them apart). Targets
//! that are no residual have no nominal model, and epoch 0 is their mean.

use acm_models::{Engine, Network};

use super::epoch::Epoch;
use super::evaluate;
use super::progress::Progress;
use crate::learn::examples::Examples;

/// Records epoch 0.
pub fn note(
    network: &Network,
    training: &dyn Examples,
    validation: &dyn Examples,
    engine: &mut Engine,
    progress: &mut Progress,
) {
    let nothing = match training.residual() {
        Some(scaler) => scaler.mean.iter().zip(&scaler.spread).map(|(m, s)| (-m / s) as f32).collect(),
        None => vec![0.0; network.outputs()],
    };
    let weights = with_output_layer(network, &nothing);
    let train_loss = evaluate::loss(engine, &weights, training);
    let validation_loss = evaluate::loss(engine, &weights, validation);
    progress.zero = Some(Epoch { epoch: 0, learning_rate: 0.0, train_loss, validation_loss });
    progress.best = weights;
}

/// Returns all values, with zeros in the place of the output layer's weights.
fn with_output_layer(network: &Network, bias: &[f32]) -> Vec<f32> {
    let mut values = network.values();
    let mut rest = values.as_mut_slice();
    for parameter in network.parameters() {
        let (own, others) = rest.split_at_mut(parameter.len());
        match parameter.name.as_str() {
            "head.weight" => own.fill(0.0),
            "head.bias" => {
                own.fill(0.0);
                own[..bias.len()].copy_from_slice(bias);
            }
            _ => {}
        }
        rest = others;
    }
    values
}
