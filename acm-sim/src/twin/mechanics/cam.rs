//! Non-circular pulleys: tendon pay-out against servo angle, from a table.
//!
//! The table lists the excess of the effective angle over the servo angle, in milliradian, every 22.5° of
//! one turn; between entries runs the periodic cubic spline (natural in the circle: value, slope and
//! curvature are continuous everywhere).
//!
//! ```text
//! (m_{k−1} + 4·m_k + m_{k+1})/6 = (v_{k+1} − 2·v_k + v_{k−1})/h²      m = curvature at the entries
//! ```
//!
//! Source: de Boor, A Practical Guide to Splines (2001), ch. IV. The numbers are as a dial gauge on a milled
//! pulley with an off-centre horn screw would read them.

const ENTRIES: usize = 16;

/// Excess angle of pulley 1 and pulley 2, mrad, at 0°, 22.5°, … 337.5°.
const TABLES: [[f64; ENTRIES]; 2] = [
    [116.0, 146.0, 135.0, 93.0, 23.0, -41.0, -84.0, -98.0, -18.0, 71.0, 78.0, 5.0, -122.0, -174.0, -130.0, 1.0],
    [183.0, 230.0, 124.0, -34.0, -155.0, -179.0, -109.0, -48.0, -3.0, -4.0, 12.0, 6.0, -15.0, -41.0, -38.0, 71.0],
];

/// Periodic spline through one table.
#[derive(Clone, Debug, PartialEq)]
pub struct Cam {
    values: [f64; ENTRIES],
    curvatures: [f64; ENTRIES],
}

impl Cam {
    /// Returns the cam of pulley 0 or 1, its profile scaled by a factor (1 as measured).
    pub fn of_pulley(pulley: usize, scale: f64) -> Self {
        let values = TABLES[pulley].map(|milliradian| 1e-3 * scale * milliradian);
        Self { values, curvatures: curvatures(&values) }
    }

    /// Returns the effective angle at a servo angle, rad.
    pub fn effective(&self, angle: f64) -> f64 {
        let step = std::f64::consts::TAU / ENTRIES as f64;
        let place = angle.rem_euclid(std::f64::consts::TAU) / step;
        let left = (place as usize) % ENTRIES;
        let right = (left + 1) % ENTRIES;
        let b = place - place.floor();
        let a = 1.0 - b;
        let bend = (a * a * a - a) * self.curvatures[left] + (b * b * b - b) * self.curvatures[right];
        angle + a * self.values[left] + b * self.values[right] + bend * step * step / 6.0
    }
}

/// Returns the curvatures of the periodic spline by Gauss–Seidel; the system is diagonally dominant by a factor of 2.
fn curvatures(values: &[f64; ENTRIES]) -> [f64; ENTRIES] {
    let step = std::f64::consts::TAU / ENTRIES as f64;
    let mut curvatures = [0.0; ENTRIES];
    for _ in 0..60 {
        for k in 0..ENTRIES {
            let (before, after) = ((k + ENTRIES - 1) % ENTRIES, (k + 1) % ENTRIES);
            let second = (values[after] - 2.0 * values[k] + values[before]) / (step * step);
            curvatures[k] = (6.0 * second - curvatures[before] - curvatures[after]) / 4.0;
        }
    }
    curvatures
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn table_is_met_at_its_entries() {
        let cam = Cam::of_pulley(0, 1.0);
        for (k, milliradian) in TABLES[0].iter().enumerate() {
            let angle = TAU * k as f64 / 16.0 - TAU;
            assert!((cam.effective(angle) - angle - 1e-3 * milliradian).abs() < 1e-12);
        }
    }

    /// Oracle: one-sided differences on both sides of each entry agree in value, slope and curvature.
    #[test]
    fn profile_is_periodic_and_twice_smooth() {
        let cam = Cam::of_pulley(1, 1.0);
        let excess = |angle: f64| cam.effective(angle) - angle;
        let d = 1e-4;
        for k in 0..=16 {
            let x = TAU * f64::from(k) / 16.0;
            let slope = |s: f64| (4.0 * excess(x + s) - 3.0 * excess(x) - excess(x + 2.0 * s)) / (2.0 * s);
            assert!((slope(d) - slope(-d)).abs() < 1e-6, "slope at entry {k}");
            let bend = |s: f64| (excess(x + 3.0 * s) - 2.0 * excess(x + 2.0 * s) + excess(x + s)) / (s * s);
            assert!((bend(d) - bend(-d)).abs() < 1e-2, "curvature at entry {k}");
            assert!((excess(x) - excess(x + TAU)).abs() < 1e-12);
        }
    }
}
