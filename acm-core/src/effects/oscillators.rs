//! Shared by second-order effects: period and damping, the grid of both, and decay times.

use std::f64::consts::TAU;

use super::{ParameterSpec, Rig, times};

/// Initial damping ratios: long ringing, overshoot, hardly any overshoot, overdamped.
const DAMPINGS: [f64; 4] = [0.06, 0.25, 0.7, 1.3];

/// Natural period, silent at 0, and damping ratio. The period may be as long as a trial: two lags of τ in series have 2πτ.
pub fn parameters(rig: &Rig) -> Vec<ParameterSpec> {
    let period = times::size(rig, "period").within(0.0, times::trial(rig));
    vec![period, ParameterSpec::shape("damping", "1", 0.7, 0.3).within(0.01, 3.0)]
}

/// Every period with each damping ratio.
pub fn grid(rig: &Rig) -> Vec<Vec<f64>> {
    times::periods(rig).into_iter().flat_map(|period| DAMPINGS.map(|damping| vec![period, damping])).collect()
}

/// Decay time of an initial state, s: one over the real part of the slower pole.
pub fn fading(period: f64, damping: f64) -> f64 {
    let apart = (damping * damping - 1.0).max(0.0).sqrt();
    period / (TAU * (damping - apart))
}

/// The same of the faster pole; none where they are equal.
pub fn fading_faster(period: f64, damping: f64) -> Option<f64> {
    (damping > 1.0).then(|| period / (TAU * (damping + (damping * damping - 1.0).sqrt())))
}

/// Angular frequency of an initial state while it decays, rad/s; 0 without oscillation.
pub fn swinging(period: f64, damping: f64) -> f64 {
    TAU / period * (1.0 - damping * damping).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 1/(1 + 3 s)(1 + 0.5 s), two lags of 3 and 0.5 s, has ω² = 1/1.5 and ζ = 3.5 ω/2.
    #[test]
    fn two_lags_fade_as_each_does() {
        let omega = (1.0f64 / 1.5).sqrt();
        let (period, damping) = (TAU / omega, 1.75 * omega);
        assert!((fading(period, damping) - 3.0).abs() < 1e-12);
        assert!((fading_faster(period, damping).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(fading_faster(period, 0.7), None);
    }

    /// Oracle: s² + 0.6 s + 9.09 = 0 at s = −0.3 ± 3i.
    #[test]
    fn an_oscillator_swings_while_it_fades() {
        let omega = 9.09f64.sqrt();
        let (period, damping) = (TAU / omega, 0.3 / omega);
        assert!((swinging(period, damping) - 3.0).abs() < 1e-12);
        assert!((1.0 / fading(period, damping) - 0.3).abs() < 1e-12);
        assert_eq!(swinging(period, 1.7), 0.0);
    }
}
