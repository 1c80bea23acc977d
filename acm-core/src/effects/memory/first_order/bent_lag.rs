//! First-order lag whose time constant depends on where it is: τ0 b(z) ż = x − z, b = ρ + (1 − ρ) (1 + κ z) (1 + |λ| z²)^{sgn λ} with
//! |z| ≤ 1 and 1 + κ z ≥ 1/20; at rest at the first sample.
//!
//! Over each of [`crate::effects::memory::substeps::PARTS`] parts of an interval the lag is exact for a constant τ, which is that of the mean
//! of z at both ends, found by two passes. Every pass draws z towards the input, so it is stable for every step; second order
//! in the part.

use crate::effects::memory::lag::relax;
use crate::effects::memory::substeps::parts;
use crate::effects::memory::{Point, State};

/// Smallest 1 + κ z.
const LEAST: f64 = 0.05;

/// Passes over a part.
const PASSES: usize = 2;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct BentLag {
    before: Option<Point>,
    z: f64,
}

impl State for BentLag {}

impl BentLag {
    /// z at the next sample; `tau` is τ0, s, `bends` are κ, λ and ρ.
    pub fn step(&mut self, time: f64, x: f64, tau: f64, bends: [f64; 3]) -> f64 {
        match self.before.filter(|before| time > before.time && tau > 1e-9) {
            Some(before) => {
                let (h, ends) = parts(before, time, x);
                let (slope, mut past) = ((x - before.x) / (time - before.time), before.x);
                for x in ends {
                    let start = self.z;
                    for _ in 0..PASSES {
                        let middle = (0.5 * (start + self.z)).clamp(-1.0, 1.0);
                        let tau = tau * bent(middle, bends);
                        self.z = relax((start, past, x), slope * tau, (-h / tau).exp());
                    }
                    past = x;
                }
            }
            None => self.z = x,
        }
        self.before = Some(Point { time, x });
        self.z
    }
}

/// b(z).
fn bent(z: f64, [bend, curve, floor]: [f64; 3]) -> f64 {
    let even = 1.0 + curve.abs() * z * z;
    floor + (1.0 - floor) * (1.0 + bend * z).max(LEAST) * if curve < 0.0 { 1.0 / even } else { even }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error behind a wave of triangles, against 400 steps of classical Runge–Kutta between two samples.
    fn worst(step: f64, bends: [f64; 3]) -> f64 {
        let time: Vec<f64> = (0..=(12.0 / step).round() as usize).map(|n| step * n as f64).collect();
        let x: Vec<f64> = time.iter().map(|t| 0.9 * (1.0 - (t / 3.0 - (t / 3.0).floor() - 0.5).abs() * 4.0)).collect();
        let (mut lag, mut z, mut most) = (BentLag::default(), x[0], 0.0f64);
        lag.step(time[0], x[0], 0.6, bends);
        for (t, x) in time.windows(2).zip(x.windows(2)) {
            let h = (t[1] - t[0]) / 400.0;
            for n in 0..400 {
                let input = |part: f64| x[0] + (x[1] - x[0]) * (f64::from(n) + part) / 400.0;
                let even = |z: f64| (1.0 + bends[1].abs() * z * z).powf(bends[1].signum());
                let pace = |z: f64| bends[2] + (1.0 - bends[2]) * (1.0 + bends[0] * z) * even(z);
                let f = |part: f64, z: f64| (input(part) - z) / (0.6 * pace(z));
                let a = f(0.0, z);
                let b = f(0.5, z + 0.5 * h * a);
                let c = f(0.5, z + 0.5 * h * b);
                let d = f(1.0, z + h * c);
                z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            }
            most = most.max((lag.step(t[1], x[1], 0.6, bends) - z).abs());
        }
        most
    }

    /// Oracle: Runge–Kutta. Halving the step divides the error by four.
    #[test]
    fn a_bent_lag_converges_at_second_order() {
        for bend in [[0.7, 0.0, 0.0], [-0.7, 0.0, 0.0], [0.0, 2.0, 0.0], [0.3, -1.5, 0.0], [0.0, -8.0, 0.25]] {
            let (coarse, fine) = (worst(0.15, bend), worst(0.075, bend));
            let order = (coarse / fine).log2();
            assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.3, "{bend:?}: {coarse:.1e}, order {order:.2}");
        }
        assert!(worst(0.15, [0.0; 3]) < 1e-9, "without a bend it is exact");
    }

    /// Steps of a thousand time constants land on the input, less what a ramp leaves behind.
    #[test]
    fn long_steps_are_stable() {
        let mut lag = BentLag::default();
        for n in 0..100 {
            let x = if n % 2 == 0 { 1.0 } else { -1.0 };
            let z = lag.step(f64::from(n), x, 1e-3, [0.95, -9.0, 0.0]);
            assert!((z - x).abs() < 0.01, "{z} at {x}");
        }
    }
}
