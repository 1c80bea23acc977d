//! Optimizers by name, and the learning rate of each epoch ([`schedule`]).

pub mod schedule;

use acm_models::optimizer::{adam, moments::Moments, rmsprop};

use crate::config::OptimizerKind;

/// Moves `values` one step against `gradient`.
///
/// # Panics
/// If the three do not have the same length.
pub fn step(
    kind: OptimizerKind,
    weight_decay: f64,
    rate: f64,
    moments: &mut Moments,
    values: &mut [f32],
    gradient: &[f32],
) {
    assert!(values.len() == gradient.len() && values.len() == moments.second.len(), "one gradient for each value");
    moments.steps += 1;
    match kind {
        OptimizerKind::Adam => adam::step(rate, weight_decay, adam::Decay::Coupled, moments, values, gradient),
        OptimizerKind::Adamw => adam::step(rate, weight_decay, adam::Decay::Decoupled, moments, values, gradient),
        OptimizerKind::Rmsprop => rmsprop::step(rate, weight_decay, moments, values, gradient),
    }
}
