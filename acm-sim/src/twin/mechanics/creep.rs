//! Relaxation of the backbone: a power law, not a sum of exponentials.
//!
//! ```text
//! m(t) = k·s·∫ G(t − u) dθ(u),     G(x) = (1 + x/t0)^(−p)
//! ```
//!
//! | symbol | meaning                              | unit    |
//! | `m`    | extra elastic moment of a joint      | N·m     |
//! | `k`    | stiffness of the joint               | N·m/rad |
//! | `s`    | share of the stiffness that relaxes  | 1       |
//! | `t0`   | onset of the power law               | s       |
//! | `p`    | exponent, p ≠ 1                      | 1       |
//!
//! With angles linear in time between steps the integral is exact:
//!
//! ```text
//! m_n/(k·s) = Σ_i W_{n−i}·(θ_i − θ_{i−1}),    W_m = (1/Δ) ∫_{mΔ}^{(m+1)Δ} G dx
//! ```
//!
//! The whole past is kept; nothing forgets exponentially. Long-lasting power-law relaxation of polymers:
//! Nutting (1921), J. Franklin Inst. 191; Bagley & Torvik (1983), J. Rheol. 27.

use crate::twin::settings::CreepSettings;
use nalgebra::DVector;
use pulp::{Arch, Simd, WithSimd};

/// Number of registers of angles whose sums are kept during the loop over the past.
const TOGETHER: usize = 4;

/// Past of all joint angles with their present weights.
#[derive(Clone, Debug)]
pub struct Creep {
    weights: Vec<f64>,
    last: DVector<f64>,
    /// Increments step after step, all angles of a step side by side.
    increments: Vec<f64>,
}

impl Creep {
    /// Returns the memory of an arm that has always rested at `angles`, for up to `steps` steps of `step` seconds.
    pub fn new(settings: &CreepSettings, step: f64, steps: usize, angles: DVector<f64>) -> Self {
        let weights = (0..=steps).map(|lag| weight(settings, step, lag)).collect();
        let increments = Vec::with_capacity(steps * angles.len());
        Self { weights, last: angles, increments }
    }

    /// Returns the relative moment per rad of the step being solved, k·s taken out.
    pub fn newest_weight(&self) -> f64 {
        self.weights[0]
    }

    /// Returns the relative moments that the past alone would leave if the angles became `θ = 0` now: add
    /// `newest_weight() · θ` for the moments at θ.
    pub fn past(&self) -> DVector<f64> {
        let mut past = -self.weights[0] * &self.last;
        let (increments, weights) = (&self.increments[..], &self.weights[1..]);
        Arch::new().dispatch(AddPast { past: past.as_mut_slice(), increments, weights });
        past
    }

    /// Accepts the solved angles of this step.
    pub fn accept(&mut self, angles: &DVector<f64>) {
        self.increments.extend(angles.iter().zip(&self.last).map(|(angle, last)| angle - last));
        self.last.copy_from(angles);
    }
}

/// Contribution of the past, as a pulp kernel.
struct AddPast<'a> {
    past: &'a mut [f64],
    increments: &'a [f64],
    weights: &'a [f64],
}

impl WithSimd for AddPast<'_> {
    type Output = ();

    /// Adds the increments, the newest first, each with the weight of its lag. Every angle has a sum of its own, in the
    /// order of the lags, so the width of a register changes no bit.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let size = self.past.len();
        let lags = || self.increments.chunks_exact(size).rev().zip(self.weights);
        let (wide, narrow) = S::as_mut_simd_f64s(self.past);
        let first_narrow = size - narrow.len();
        for (block, past) in wide.chunks_mut(TOGETHER).enumerate() {
            let mut sums = [simd.splat_f64s(0.0); TOGETHER];
            sums[..past.len()].copy_from_slice(past);
            for (increment, weight) in lags() {
                let (weight, increment) = (simd.splat_f64s(*weight), &S::as_simd_f64s(increment).0[TOGETHER * block..]);
                match increment.first_chunk::<TOGETHER>() {
                    Some([a, b, c, d]) => {
                        sums[0] = simd.add_f64s(sums[0], simd.mul_f64s(weight, *a));
                        sums[1] = simd.add_f64s(sums[1], simd.mul_f64s(weight, *b));
                        sums[2] = simd.add_f64s(sums[2], simd.mul_f64s(weight, *c));
                        sums[3] = simd.add_f64s(sums[3], simd.mul_f64s(weight, *d));
                    }
                    None => {
                        for (sum, x) in sums.iter_mut().zip(increment) {
                            *sum = simd.add_f64s(*sum, simd.mul_f64s(weight, *x));
                        }
                    }
                }
            }
            past.copy_from_slice(&sums[..past.len()]);
        }
        for (increment, weight) in lags() {
            narrow.iter_mut().zip(&increment[first_narrow..]).for_each(|(sum, x)| *sum += weight * x);
        }
    }
}

/// Returns the mean of G over the step that lies `lag` steps back.
fn weight(settings: &CreepSettings, step: f64, lag: usize) -> f64 {
    let power = 1.0 - settings.exponent;
    let primitive = |x: f64| settings.onset / power * (1.0 + x / settings.onset).powf(power);
    let from = lag as f64 * step;
    settings.share * (primitive(from + step) - primitive(from)) / step
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> CreepSettings {
        CreepSettings { share: 0.5, onset: 2.0, exponent: 0.7 }
    }

    /// Oracle: after a fast turn by 1 rad the moment is G itself.
    #[test]
    fn relaxation_after_a_turn_follows_the_power_law() {
        let step = 0.01;
        let mut creep = Creep::new(&settings(), step, 4000, DVector::zeros(1));
        for n in 1..=3000 {
            creep.accept(&DVector::from_element(1, 1.0));
            let time = step * f64::from(n) - step / 2.0;
            let moment = creep.past()[0] + creep.newest_weight();
            let expected = 0.5 * (1.0 + (time + step) / 2.0f64).powf(-0.7);
            assert!((moment - expected).abs() < 1e-5, "t = {time}: {moment} {expected}");
        }
    }

    /// Oracle: the closed-form moment of a ramp, s·∫G over its duration.
    #[test]
    fn ramp_is_exact_at_any_step() {
        let closed = 0.5 * 2.0 / 0.3 * ((1.0 + 3.0 / 2.0f64).powf(0.3) - 1.0);
        for steps in [3, 30] {
            let step = 3.0 / steps as f64;
            let mut creep = Creep::new(&settings(), step, steps, DVector::zeros(1));
            let mut moment = 0.0;
            for n in 1..=steps {
                let angle = step * n as f64;
                moment = creep.past()[0] + creep.newest_weight() * angle;
                creep.accept(&DVector::from_element(1, angle));
            }
            assert!((moment - closed).abs() < 1e-12, "{steps} steps: {moment} {closed}");
        }
    }
}
