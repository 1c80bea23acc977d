//! Level of a vessel that empties through an orifice: τ ż = 2 (√(1 + κx) − √(1 + κz))/κ, roots of no less than zero; at rest at the first
//! sample.
//!
//! It is a first-order lag with the time constant τ (√(1 + κx) + √(1 + κz))/2. Over each of [`crate::effects::memory::substeps::PARTS`] parts of an interval
//! the lag is exact for a constant one, which is that of the means of x and of z at both ends, found by two passes. Every pass draws z
//! towards the input, so it is stable for every step; second order in the part.

use crate::effects::memory::lag::relax;
use crate::effects::memory::substeps::parts;
use crate::effects::memory::{Point, State};

/// Smallest root: near the bottom it empties in no time.
const LEAST: f64 = 1e-6;

/// Passes over a part.
const PASSES: usize = 2;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct RootLag {
    before: Option<Point>,
    z: f64,
}

impl State for RootLag {}

impl RootLag {
    /// z at the next sample; `tau` is τ, s, `bend` is κ.
    pub fn step(&mut self, time: f64, x: f64, tau: f64, bend: f64) -> f64 {
        match self.before.filter(|before| time > before.time && tau > 1e-9) {
            Some(before) => {
                let (h, ends) = parts(before, time, x);
                let (slope, mut past) = ((x - before.x) / (time - before.time), before.x);
                for x in ends {
                    let (start, flows_in) = (self.z, root(0.5 * (past + x), bend));
                    for _ in 0..PASSES {
                        let tau = tau * 0.5 * (flows_in + root(0.5 * (start + self.z), bend));
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

/// √(1 + κz).
fn root(z: f64, bend: f64) -> f64 {
    (1.0 + bend * z).max(LEAST * LEAST).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error behind a wave of triangles, against 400 steps of classical Runge–Kutta between two samples.
    fn worst(step: f64, bend: f64) -> f64 {
        let time: Vec<f64> = (0..=(12.0 / step).round() as usize).map(|n| step * n as f64).collect();
        let x: Vec<f64> = time.iter().map(|t| 0.9 * (1.0 - (t / 3.0 - (t / 3.0).floor() - 0.5).abs() * 4.0)).collect();
        let (mut lag, mut z, mut most) = (RootLag::default(), x[0], 0.0f64);
        lag.step(time[0], x[0], 0.6, bend);
        for (t, x) in time.windows(2).zip(x.windows(2)) {
            let h = (t[1] - t[0]) / 400.0;
            for n in 0..400 {
                let input = |part: f64| x[0] + (x[1] - x[0]) * (f64::from(n) + part) / 400.0;
                let flow = |level: f64| (1.0 + bend * level).sqrt();
                let f = |part: f64, z: f64| 2.0 * (flow(input(part)) - flow(z)) / (0.6 * bend);
                let a = f(0.0, z);
                let b = f(0.5, z + 0.5 * h * a);
                let c = f(0.5, z + 0.5 * h * b);
                let d = f(1.0, z + h * c);
                z += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            }
            most = most.max((lag.step(t[1], x[1], 0.6, bend) - z).abs());
        }
        most
    }

    /// Oracle: Runge–Kutta. Halving the step divides the error by four.
    #[test]
    fn an_orifice_converges_at_second_order() {
        for bend in [0.3, 0.7, 0.95] {
            let (coarse, fine) = (worst(0.15, bend), worst(0.075, bend));
            let order = (coarse / fine).log2();
            assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.3, "{bend}: {coarse:.1e}, order {order:.2}");
        }
    }

    /// Steps of a thousand time constants land on the input, less what a ramp leaves behind; below the bottom it stays finite.
    #[test]
    fn long_steps_are_stable() {
        let mut lag = RootLag::default();
        for n in 0..100 {
            let x = if n % 2 == 0 { 1.0 } else { -3.0 };
            let z = lag.step(f64::from(n), x, 1e-3, 0.98);
            assert!((z - x).abs() < 0.01, "{z} at {x}");
        }
    }
}
