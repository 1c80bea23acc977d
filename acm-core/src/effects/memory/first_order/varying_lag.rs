//! First-order lag whose time constant depends on its input and its state: τ b(x, z) ż = x − z; at rest at the first sample.
//!
//! Over each part of an interval ([`parts`]) the lag is exact for a constant τ: that of the means of x and of z at both ends, from
//! two fixed-point passes. Every pass moves z towards the input, so it is stable for every step; second order in the part.

use crate::effects::memory::lag::relax;
use crate::effects::memory::substeps::parts;
use crate::effects::memory::{Point, State};

/// Passes over a part.
const PASSES: usize = 2;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct VaryingLag {
    before: Option<Point>,
    z: f64,
}

impl State for VaryingLag {}

impl VaryingLag {
    /// Time constant up to which there is no lag, s.
    pub const NONE: f64 = 1e-9;

    /// z at the next sample; `tau` is τ, s, and `paces(x)(z)` is b, above 0.
    #[inline]
    pub fn step<B: Fn(f64) -> f64>(&mut self, time: f64, x: f64, tau: f64, paces: impl Fn(f64) -> B) -> f64 {
        match self.before.filter(|before| time > before.time && tau > Self::NONE) {
            Some(before) => {
                let (h, ends) = parts(before, time, x, tau * paces(x)(self.z));
                let (slope, mut past) = ((x - before.x) / (time - before.time), before.x);
                for x in ends {
                    let (start, pace) = (self.z, paces(0.5 * (past + x)));
                    for _ in 0..PASSES {
                        let tau = tau * pace(0.5 * (start + self.z));
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

    /// Overwrites z after a step, where it is held.
    pub fn hold(&mut self, z: f64) {
        self.z = z;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAU: f64 = 0.6;

    /// Largest error behind a wave of triangles, against 400 steps of classical Runge–Kutta of `b(x, z)` between two samples.
    fn worst(step: f64, b: impl Fn(f64, f64) -> f64) -> f64 {
        let time: Vec<f64> = (0..=(12.0 / step).round() as usize).map(|n| step * n as f64).collect();
        let x: Vec<f64> = time.iter().map(|t| 0.9 * (1.0 - (t / 3.0 - (t / 3.0).floor() - 0.5).abs() * 4.0)).collect();
        let (b, mut lag, mut z, mut most) = (&b, VaryingLag::default(), x[0], 0.0f64);
        lag.step(time[0], x[0], TAU, |x| move |z| b(x, z));
        for (t, x) in time.windows(2).zip(x.windows(2)) {
            let h = (t[1] - t[0]) / 400.0;
            for n in 0..400 {
                let input = |part: f64| x[0] + (x[1] - x[0]) * (f64::from(n) + part) / 400.0;
                let f = |part: f64, z: f64| (input(part) - z) / (TAU * b(input(part), z));
                let first = f(0.0, z);
                let second = f(0.5, z + 0.5 * h * first);
                let third = f(0.5, z + 0.5 * h * second);
                let fourth = f(1.0, z + h * third);
                z += h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
            }
            most = most.max((lag.step(t[1], x[1], TAU, |x| move |z| b(x, z)) - z).abs());
        }
        most
    }

    /// Oracle: Runge–Kutta. Halving the step divides the error by four; where b depends on z, on its square, or on both x and z.
    #[test]
    fn a_varying_lag_converges_at_second_order() {
        let paces: [fn(f64, f64) -> f64; 5] = [
            |_, z| 1.0 + 0.7 * z,
            |_, z| 1.0 - 0.7 * z,
            |_, z| 1.0 + 2.0 * z * z,
            |_, z| 0.25 + 0.75 / (1.0 + 8.0 * z * z),
            |x, z| 0.5 * ((1.0 + 0.95 * x).sqrt() + (1.0 + 0.95 * z).sqrt()),
        ];
        for (k, pace) in paces.into_iter().enumerate() {
            let (coarse, fine) = (worst(0.012, pace), worst(0.006, pace));
            let order = (coarse / fine).log2();
            assert!(coarse < 1e-3 && (order - 2.0).abs() < 0.3, "{k}: {coarse:.1e}, order {order:.2}");
            // Of 1, 2 or 4 parts.
            assert!([0.15, 0.06, 0.03].iter().all(|step| worst(*step, pace) < 2e-3), "{k}");
        }
        assert!(worst(0.15, |_, _| 1.0) < 1e-9, "of a constant time constant it is exact");
    }

    /// Steps of a thousand time constants land on the input, less what a ramp leaves behind.
    #[test]
    fn long_steps_are_stable() {
        let mut lag = VaryingLag::default();
        for n in 0..100 {
            let x = if n % 2 == 0 { 1.0 } else { -1.0 };
            let z = lag.step(f64::from(n), x, 1e-3, |x: f64| move |z: f64| 1.0 + 0.9 * z.clamp(-1.0, 1.0) + x * x);
            assert!((z - x).abs() < 0.01, "{z} at {x}");
        }
    }
}
