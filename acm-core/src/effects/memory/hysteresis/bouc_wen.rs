//! Bouc–Wen state of exponent 1 in units of its saturation, at rest at the first sample; within ±1.
//!
//! ```text
//! δ dz = dx − ½(1 + a) |dx| z − ½(1 − a) dx |z|
//! ```
//!
//! Away from rest, z relaxes to ±1 over the `width` δ; back to rest, it moves at slope 1 + a|z|: `asymmetry` a = 1 is
//! Dahl's state, δ dd = (sgn v − d) |dx|; a = 0 returns on a straight line. Each piece is exponential, and a step is cut
//! where z passes 0.

use crate::effects::memory::State;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct BoucWen {
    before: Option<f64>,
    z: f64,
}

impl State for BoucWen {}

impl BoucWen {
    /// z at the next sample.
    #[inline]
    pub fn step(&mut self, x: f64, width: f64, asymmetry: f64) -> f64 {
        let step = x - self.before.unwrap_or(x);
        if step != 0.0 {
            let way = step.abs() / width.max(f64::MIN_POSITIVE);
            self.z = step.signum() * away(step.signum() * self.z, way, asymmetry);
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
    // Dahl's state returns as it came: one law on either side of rest.
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
