//! Bouc–Wen state in units of its saturation, within ±1; at rest at the first sample unless set otherwise.
//!
//! ```text
//! δ dz = dx − ½(1 + a) |dx| |z|^{n−1} z − ½(1 − a) dx |z|^n
//! ```
//!
//! While |z| grows, z relaxes to ±1 over the `width` δ; while it falls, the slope is 1 + a|z|^n. `asymmetry` a = 1 with exponent
//! n = 1 is Dahl's state, δ dd = (sgn v − d) |dx|; a = 0 returns on a straight line; a large n yields suddenly. With n = 1 each
//! piece is exponential, and a step is cut where z passes 0. Other exponents have no closed form: classical Runge–Kutta, in
//! pieces shorter than δ/n.

use super::super::State;

/// A Bouc–Wen state.
#[derive(Debug, Clone, Copy, Default)]
pub struct BoucWen {
    before: Option<f64>,
    z: f64,
}

impl State for BoucWen {}

/// Longest piece in units of δ/n: wrong by less than 1e-4 of saturation.
const PIECE: f64 = 0.5;

/// Distance that counts as saturated.
const SATURATED: f64 = 1e-9;

/// Pieces that saturate any state.
const MOST: f64 = 4096.0;

impl BoucWen {
    /// z at the next sample, with exponent 1.
    #[inline]
    pub fn step(&mut self, x: f64, width: f64, asymmetry: f64) -> f64 {
        self.moved(x, width, |z, way| away(z, way, asymmetry))
    }

    /// z at the next sample, with any exponent from 1 on and an asymmetry above −1.
    #[inline]
    pub fn step_of_power(&mut self, x: f64, width: f64, asymmetry: f64, exponent: f64) -> f64 {
        self.moved(x, width, |z, way| away_of_power(z, way, asymmetry, exponent))
    }

    /// Sets z; no effect after a first sample.
    #[inline]
    pub fn begin(&mut self, z: f64) {
        if self.before.is_none() {
            self.z = z;
        }
    }

    #[inline]
    fn moved(&mut self, x: f64, width: f64, away: impl Fn(f64, f64) -> f64) -> f64 {
        let step = x - self.before.unwrap_or(x);
        if step != 0.0 {
            let way = step.abs() / width.max(f64::MIN_POSITIVE);
            self.z = step.signum() * away(step.signum() * self.z, way);
        }
        self.before = Some(x);
        self.z
    }

    /// Dahl's state at the next sample.
    #[inline]
    pub fn dahl(&mut self, x: f64, presliding: f64) -> f64 {
        self.step(x, presliding, 1.0)
    }
}

/// The state after a motion of `way` widths in its positive direction.
fn away(z: f64, way: f64, a: f64) -> f64 {
    // Dahl's state has the same law on either side of rest.
    if z >= 0.0 || a == 1.0 {
        return z - (1.0 - z) * (-way).exp_m1();
    }
    let curved = a.abs() > 1e-9;
    let faded = (-a * way).exp_m1();
    let returned = if curved { z + (z - 1.0 / a) * faded } else { z + way };
    if returned <= 0.0 {
        return returned;
    }
    let back = if curved { (-a * z).ln_1p() / a } else { -z };
    -(back - way).exp_m1()
}

/// The same with exponent n.
fn away_of_power(z: f64, way: f64, a: f64, n: f64) -> f64 {
    let slope = |z: f64| 1.0 - z.abs().powf(n) * if z < 0.0 { -a } else { 1.0 };
    let pieces = (way * n / PIECE).ceil().min(MOST);
    let h = if pieces < MOST { way / pieces } else { PIECE / n };
    let mut z = z;
    for _ in 0..pieces as usize {
        if z > 1.0 - SATURATED {
            return 1.0;
        }
        let k1 = slope(z);
        let k2 = slope(z + 0.5 * h * k1);
        let k3 = slope(z + 0.5 * h * k2);
        let k4 = slope(z + h * k3);
        z = (z + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)).min(1.0);
    }
    z
}
