//! Epoch 0: a network that adds nothing.
//!
//! ```text
//! W_head = 0        b_head = −m / s  (epoch 0, adds nothing)        b_head = 0  (first step, adds m)
//! ```
//!
//! | symbol | meaning                                        | shape | unit |
//! | ------ | ---------------------------------------------- | ----- | ---- |
//! | `m, s` | mean and spread of the targets in training     | [O]   | m    |
//!
//! Steps start from the mean of the training part, as far away as it may be, and not from nothing: an optimizer moves a bias
//! by one learning rate a step. Targets that are no residual have no nominal model, and epoch 0 is their mean.

use acm_models::{Engine, Network};

use super::{epoch::Epoch, evaluate, examples::Examples, progress::Progress};

/// Sets the output layer to zero.
pub fn at_zero(network: &mut Network) {
    let values = with_output_layer(network, &vec![0.0; network.outputs()]);
    network.set_values(&values);
}

/// Notes epoch 0 of a network that starts at zero.
pub fn note(
    network: &Network,
    training: &impl Examples,
    validation: &impl Examples,
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

/// All values, with zeros in the place of the output layer's weights.
fn with_output_layer(network: &Network, bias: &[f32]) -> Vec<f32> {
    let mut values = network.values();
    let mut rest = values.as_mut_slice();
    for parameter in network.parameters() {
        let (own, others) = rest.split_at_mut(parameter.len());
        match parameter.name.as_str() {
            "head.weight" => own.fill(0.0),
            "head.bias" => own.copy_from_slice(bias),
            _ => {}
        }
        rest = others;
    }
    values
}
