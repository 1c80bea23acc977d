//! From a gradient to a step: the list of optimizers and the state that they keep.

use serde::{Deserialize, Serialize};

use super::{adam, rmsprop};

/// An average square below this is as good as none: its root, times Adam's largest correction of 32, is less than half of
/// the last digit of ε = 10⁻⁸. Smaller ones would end among the numbers that are not normal, which are slow.
pub(super) const FAINT_SQUARE: f32 = 1e-34;

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
    /// Torch's default weight decay.
    pub fn default_weight_decay(self) -> f64 {
        match self {
            Self::Adamw => 0.01,
            Self::Adam | Self::Rmsprop => 0.0,
        }
    }
}

/// Running averages, one value for each parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// Steps taken.
    pub steps: u64,
    /// Average gradient; stays zero in RMSprop.
    pub first: Vec<f32>,
    /// Average squared gradient.
    pub second: Vec<f32>,
}

impl Moments {
    /// Before the first step, for `count` parameters.
    pub fn new(count: usize) -> Self {
        Self { steps: 0, first: vec![0.0; count], second: vec![0.0; count] }
    }
}

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

#[cfg(test)]
pub(super) mod tests {
    use pulp::Arch;

    use super::*;

    /// Every set of vector instructions that this processor has.
    pub fn architectures() -> Vec<Arch> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let wide = [pulp::x86::V3::try_new().map(Arch::V3), pulp::x86::V4::try_new().map(Arch::V4)];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let wide = [None];
        wide.into_iter().flatten().chain([Arch::Scalar, Arch::new()]).collect()
    }

    /// Oracle: 1 plus half of its last digit rounds to 1; so does ε with what is forgotten, and not with ten thousand times that.
    #[test]
    fn a_forgotten_square_changes_no_digit() {
        let with = |square: f32| square.sqrt() * 32.0 + 1e-8f32;
        assert_eq!(with(FAINT_SQUARE), 1e-8);
        assert_ne!(with(1e4 * FAINT_SQUARE), 1e-8);
    }
}
