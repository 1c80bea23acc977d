//! Delay of the flow around an element behind its motion: a dead time along the wake, and dispersion.
//!
//! ```text
//! F_k(t) = ∫ g_k(x)·f_k(t − x) dx,     g_k = gamma density of shape n, started at t_d
//! mean of g_k = t_d + s_k/U_c
//! ```
//!
//! | symbol | meaning                                            | unit |
//! | `f_k`  | load of the wind at the element's present place    | N    |
//! | `F_k`  | load that acts                                     | N    |
//! | `t_d`  | dead time, during which the old wake goes on       | s    |
//! | `s_k`  | arc length of the element                          | m    |
//! | `U_c`  | speed at which the disturbed wake reorders         | m/s  |
//!
//! Advection with dispersion spreads a front into a gamma density (Levenspiel, Chemical Reaction
//! Engineering (1999), ch. 14: tanks in series); nothing here is a first-order lag.

use crate::twin::settings::WindSettings;
use nalgebra::Vector3;

/// Past loads of every point with the weights of its delay.
#[derive(Clone, Debug)]
pub struct Transport {
    weights: Vec<Vec<f64>>,
    past: Vec<Vec<Vector3<f64>>>,
}

impl Transport {
    /// Returns the delays for points at these arc lengths (m); past loads start at zero.
    pub fn new(settings: &WindSettings, arc_lengths: &[f64], step: f64) -> Self {
        let weights: Vec<_> = arc_lengths.iter().map(|s| delay_weights(settings, *s, step)).collect();
        Self { past: vec![Vec::new(); weights.len()], weights }
    }

    /// Returns the load that acts on a point at the coming step.
    pub fn acting(&self, point: usize) -> Vector3<f64> {
        let newest_first = self.past[point].iter().rev();
        newest_first.zip(&self.weights[point]).map(|(load, weight)| *load * *weight).sum()
    }

    /// Adds the load that the wind would make at the point's present place.
    pub fn push(&mut self, point: usize, load: Vector3<f64>) {
        let kept = self.weights[point].len();
        let past = &mut self.past[point];
        if past.len() >= 2 * kept {
            past.drain(..past.len() - kept);
        }
        past.push(load);
    }
}

/// Returns the weight of the load one, two, … steps back: the gamma density integrated over each step; they add up to
/// 1.
fn delay_weights(settings: &WindSettings, arc_length: f64, step: f64) -> Vec<f64> {
    let count = (settings.longest_delay / step).ceil() as usize;
    let mean = arc_length / settings.convection;
    let up_to = |time: f64| gamma_share(settings.dispersion_shape, mean, time - settings.dead_delay);
    let mut weights: Vec<f64> =
        (1..=count).map(|lag| up_to((lag as f64 + 0.5) * step) - up_to((lag as f64 - 0.5) * step)).collect();
    // What would act within the first half step or after the longest delay goes to the nearest one kept.
    weights[0] += up_to(0.5 * step);
    weights[count - 1] += 1.0 - up_to((count as f64 + 0.5) * step);
    weights
}

/// Returns the distribution function of a gamma density of whole-number shape n and given mean.
///
/// ```text
/// P = 1 − e^{−y} Σ_{i<n} yⁱ/i!,   y = n·t/mean
/// ```
fn gamma_share(shape: u32, mean: f64, time: f64) -> f64 {
    if time <= 0.0 {
        return 0.0;
    }
    let y = f64::from(shape) * time / mean.max(1e-9);
    let mut term = 1.0;
    let mut sum = 1.0;
    for i in 1..shape {
        term *= y / f64::from(i);
        sum += term;
    }
    if y > 700.0 { 1.0 } else { 1.0 - (-y).exp() * sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> WindSettings {
        WindSettings {
            dead_delay: 0.1,
            convection: 1.0,
            dispersion_shape: 4,
            longest_delay: 3.0,
            ..WindSettings::default()
        }
    }

    /// Oracle: moments of the gamma density, mean t_d + μ and variance μ²/n.
    #[test]
    fn delay_has_the_stated_mean_and_spread() {
        let step = 0.002;
        let weights = delay_weights(&settings(), 0.4, step);
        let total: f64 = weights.iter().sum();
        let lag = |k: usize| (k as f64 + 1.0) * step;
        let mean: f64 = weights.iter().enumerate().map(|(k, w)| w * lag(k)).sum();
        let variance: f64 = weights.iter().enumerate().map(|(k, w)| w * (lag(k) - mean).powi(2)).sum();
        assert!((total - 1.0).abs() < 1e-12);
        assert!((mean - 0.5).abs() < 1e-3, "{mean}");
        assert!((variance - 0.04).abs() < 1e-3, "{variance}");
    }

    #[test]
    fn steady_load_arrives_in_full_and_nothing_before_the_dead_time() {
        let mut transport = Transport::new(&settings(), &[0.4], 0.05);
        transport.push(0, Vector3::x());
        assert!(transport.acting(0).x < 1e-3);
        for _ in 0..200 {
            transport.push(0, Vector3::x());
        }
        assert!((transport.acting(0).x - 1.0).abs() < 1e-12);
    }
}
