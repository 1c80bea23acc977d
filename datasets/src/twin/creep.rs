//! Relaxation of the backbone: a power law, not a sum of exponentials.
//!
//!     m(t) = k·s·∫ G(t − u) dθ(u),     G(x) = (1 + x/t0)^(−p)
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
//!     m_n/(k·s) = Σ_i W_{n−i}·(θ_i − θ_{i−1}),    W_m = (1/Δ) ∫_{mΔ}^{(m+1)Δ} G dx
//!
//! The whole past is kept; nothing forgets exponentially. Long-lasting power-law relaxation of polymers:
//! Nutting (1921), J. Franklin Inst. 191; Bagley & Torvik (1983), J. Rheol. 27.

use super::settings::CreepSettings;
use nalgebra::DVector;

/// Past of all joint angles with the weights that it has now.
#[derive(Clone, Debug)]
pub struct Creep {
    weights: Vec<f64>,
    last: DVector<f64>,
    increments: Vec<DVector<f64>>,
}

impl Creep {
    /// An arm that has rested at `angles` for ever, for up to `steps` steps of `step` seconds.
    pub fn new(settings: &CreepSettings, step: f64, steps: usize, angles: DVector<f64>) -> Self {
        let weights = (0..=steps).map(|lag| weight(settings, step, lag)).collect();
        Self { weights, last: angles, increments: Vec::with_capacity(steps) }
    }

    /// Relative moment per rad of the step being solved, k·s taken out.
    pub fn newest_weight(&self) -> f64 {
        self.weights[0]
    }

    /// Relative moments that the past alone would leave if the angles became `θ = 0` now:
    /// add `newest_weight() · θ` for the moments at θ.
    pub fn past(&self) -> DVector<f64> {
        let mut past = -self.weights[0] * &self.last;
        for (increment, weight) in self.increments.iter().rev().zip(&self.weights[1..]) {
            past.axpy(*weight, increment, 1.0);
        }
        past
    }

    /// Accepts the solved angles of this step.
    pub fn accept(&mut self, angles: &DVector<f64>) {
        self.increments.push(angles - &self.last);
        self.last.copy_from(angles);
    }
}

/// Mean of G over the step that lies `lag` steps back.
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
            let time = step * n as f64 - step / 2.0;
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
