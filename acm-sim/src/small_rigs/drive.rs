//! Inputs of one trial as knots between which they are linear, and the times at which outputs are sampled.
//!
//! For the truth, knots are many and exact; for an oracle, they are the recorded samples. Rate and acceleration of an
//! actuator come from a parabola through the knots near each time:
//!
//! ```text
//! min over a, b, c of  Σ_k K((t_k − t)/h)·(u_k − a − b·(t_k − t) − c·(t_k − t)²/2)²,   K(x) = e^(−x²/2), |x| ≤ 3
//! ```
//!
//! It is exact for parabolas on any spacing. Fan & Gijbels (1996), Local Polynomial Modelling, ch. 3.

use nalgebra::{Matrix3, Vector3};

/// Inputs of one trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Times of the knots, s.
    pub time: Vec<f64>,
    /// Actuators on the knots.
    pub actuators: Vec<Vec<f64>>,
    /// Contexts on the knots.
    pub contexts: Vec<Vec<f64>>,
    /// Sampling times of the outputs, s.
    pub asked: Vec<f64>,
    /// Position, rate and acceleration of one actuator at the sampling times; empty where no plant needs them.
    pub motion: [Vec<f64>; 3],
}

impl Drive {
    /// Fills [`Drive::motion`] of an actuator from parabolas of half-width `reach` seconds.
    pub fn with_motion(mut self, actuator: usize, reach: f64) -> Self {
        let found: Vec<Vector3<f64>> =
            self.asked.iter().map(|t| parabola(&self.time, &self.actuators[actuator], *t, reach)).collect();
        self.motion = [0, 1, 2].map(|order| found.iter().map(|parts| parts[order]).collect());
        self
    }

    /// Returns the values on the knots at the sampling times.
    pub fn ask(&self, values: &[f64]) -> Vec<f64> {
        self.asked.iter().map(|time| interpolate(&self.time, values, *time)).collect()
    }
}

/// Returns the value at a time, linear between knots and held beyond the ends.
pub fn interpolate(knots: &[f64], values: &[f64], time: f64) -> f64 {
    let right = knots.partition_point(|knot| *knot <= time);
    if right == 0 {
        return values[0];
    }
    if right == knots.len() {
        return values[right - 1];
    }
    let share = (time - knots[right - 1]) / (knots[right] - knots[right - 1]);
    values[right - 1] + share * (values[right] - values[right - 1])
}

fn parabola(knots: &[f64], values: &[f64], time: f64, reach: f64) -> Vector3<f64> {
    let mut from = knots.partition_point(|knot| *knot < time - 3.0 * reach);
    let mut to = knots.partition_point(|knot| *knot <= time + 3.0 * reach);
    // Five knots at least, so that sparse ends have a parabola.
    while to - from < 5.min(knots.len()) {
        from = from.saturating_sub(1);
        to = (to + 1).min(knots.len());
    }
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (knot, value) in knots[from..to].iter().zip(&values[from..to]) {
        let s = (knot - time) / reach;
        let row = Vector3::new(1.0, s, 0.5 * s * s);
        let weight = (-0.5 * s * s).exp().max(1e-6);
        normal += weight * row * row.transpose();
        right += weight * *value * row;
    }
    let found = normal.lu().solve(&right).unwrap_or_else(Vector3::zeros);
    Vector3::new(found[0], found[1] / reach, found[2] / (reach * reach))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: derivatives of a parabola by hand, on uneven knots.
    #[test]
    fn parabolas_are_exact_on_uneven_knots() {
        let time: Vec<f64> = (0..60).map(|n| 0.01 * f64::from(n) + 0.003 * f64::from(n % 3)).collect();
        let u = time.iter().map(|t| 2.0 - 3.0 * t + 5.0 * t * t).collect();
        let drive = Drive {
            asked: vec![0.0, 0.31, 0.6],
            time,
            actuators: vec![u],
            contexts: vec![],
            motion: [const { vec![] }; 3],
        };
        let [place, rate, bend] = drive.with_motion(0, 0.02).motion;
        for (k, t) in [0.0, 0.31, 0.6f64].into_iter().enumerate() {
            assert!((place[k] - (2.0 - 3.0 * t + 5.0 * t * t)).abs() < 1e-9, "{t}");
            assert!((rate[k] - (10.0 * t - 3.0)).abs() < 1e-6 && (bend[k] - 10.0).abs() < 1e-4, "{t}");
        }
    }

    #[test]
    fn interpolation_by_hand() {
        let (knots, values) = ([0.0, 1.0, 3.0], [2.0, 4.0, 0.0]);
        let got = [-1.0, 0.5, 2.0, 9.0].map(|t| interpolate(&knots, &values, t));
        assert_eq!(got, [2.0, 3.0, 2.0, 0.0]);
    }
}
