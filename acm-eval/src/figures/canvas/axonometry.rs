//! Axonometric projection: space on paper with one scale along every direction of the paper.
//!
//! ```text
//! u = −x sin a + y cos a
//! v = z cos e − (x cos a + y sin a) sin e
//! ```
//!
//! | symbol | meaning                                                | unit |
//! | `a`    | azimuth of the eye, from x towards y                   | rad  |
//! | `e`    | elevation of the eye over the x–y plane                | rad  |
//! | `u, v` | to the right and up on the paper                       | as x |

/// Direction of view.
#[derive(Debug, Clone, Copy)]
pub struct Eye {
    azimuth: f64,
    elevation: f64,
}

impl Eye {
    /// Returns the view from azimuth and elevation, degrees.
    pub fn at(azimuth: f64, elevation: f64) -> Self {
        Self { azimuth: azimuth.to_radians(), elevation: elevation.to_radians() }
    }

    /// Returns the point on the paper.
    pub fn sees(&self, [x, y, z]: [f64; 3]) -> (f64, f64) {
        let ((sa, ca), (se, ce)) = (self.azimuth.sin_cos(), self.elevation.sin_cos());
        (y * ca - x * sa, z * ce - (x * ca + y * sa) * se)
    }
}

/// Returns an arrow on the paper: one stroke from `from` to `to` with two barbs.
pub fn arrow(from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64)> {
    let (u, v) = (to.0 - from.0, to.1 - from.1);
    let barb = |side: f64| (to.0 - 0.28 * u - side * 0.14 * v, to.1 - 0.28 * v + side * 0.14 * u);
    vec![from, to, barb(1.0), to, barb(-1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near((u, v): (f64, f64), expected: (f64, f64)) {
        assert!((u - expected.0).abs() < 1e-12 && (v - expected.1).abs() < 1e-12, "({u}, {v})");
    }

    /// Oracle: what an eye on an axis sees.
    #[test]
    fn eyes_on_the_axes() {
        let point = [1.0, 2.0, 3.0];
        near(Eye::at(0.0, 0.0).sees(point), (2.0, 3.0)); // from +x: y to the right, z up
        near(Eye::at(-90.0, 0.0).sees(point), (1.0, 3.0)); // from −y: x to the right
        near(Eye::at(0.0, 90.0).sees(point), (2.0, -1.0)); // from above, x towards the reader
    }

    /// Oracle: for orthonormal axes the squared shadows of the three unit vectors sum to 2.
    #[test]
    fn lengths_on_paper_are_a_projection() {
        let eye = Eye::at(37.0, 21.0);
        let shadow = |axis: usize| {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            let (u, v) = eye.sees(unit);
            u * u + v * v
        };
        assert!(((0..3).map(shadow).sum::<f64>() - 2.0).abs() < 1e-12);
    }
}
