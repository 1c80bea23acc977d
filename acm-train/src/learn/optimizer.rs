//! Optimizers by name.
//!
//! Beside them: clipping of the gradient ([`clip`]) and the learning rate of each epoch ([`schedule`]).

pub mod adam;
pub mod clip;
pub mod moments;
pub mod rmsprop;
pub mod schedule;

use crate::config::OptimizerKind;
use moments::Moments;

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

    use crate::learn::optimizer::moments::FAINT_SQUARE;

    /// Returns every set of vector instructions that this processor has.
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
