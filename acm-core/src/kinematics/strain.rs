//! Strain bases: how bending is distributed along the arm.
//!
//! ```text
//! κ_i(s) = Σ_n c_{i,n} φ_n(s/L)
//! ```
//!
//! | basis       | φ_n(u)                                       | functions    |
//! | `legendre`  | shifted Legendre polynomial P_n(2u − 1)      | order + 1    |
//! | `piecewise` | 1 on segment n of equal length, otherwise 0  | segments     |
//!
//! `u = s/L` runs from 0 at the base to 1 at the tip; c_{i,n} in rad/m.

use serde::{Deserialize, Serialize};

/// Largest Legendre order and largest number of segments that are accepted.
pub const LARGEST: usize = 64;

/// How bending may vary along the arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "basis", rename_all = "snake_case", deny_unknown_fields)]
pub enum StrainBasis {
    /// Shifted Legendre polynomials up to `order`; order 0 is constant curvature.
    Legendre {
        /// Highest polynomial order.
        order: usize,
    },
    /// Constant curvature on each of `segments` segments of equal length.
    Piecewise {
        /// Number of segments.
        segments: usize,
    },
}

impl Default for StrainBasis {
    /// The paper's selected model: linear curvature.
    fn default() -> Self {
        Self::Legendre { order: 1 }
    }
}

impl StrainBasis {
    /// Number of basis functions.
    pub fn functions(&self) -> usize {
        match *self {
            Self::Legendre { order } => order + 1,
            Self::Piecewise { segments } => segments,
        }
    }

    /// Places in (0, 1) where strain may jump, so that no integration step may cross them.
    pub fn borders(&self) -> Vec<f64> {
        match *self {
            Self::Legendre { .. } => Vec::new(),
            Self::Piecewise { segments } => (1..segments).map(|n| n as f64 / segments as f64).collect(),
        }
    }

    /// Whether strain is constant between two neighbouring borders; one step is exact there.
    pub fn is_constant_between_borders(&self) -> bool {
        !matches!(*self, Self::Legendre { order } if order > 0)
    }

    /// Index of the first function that may differ from zero at `u`, and the values from there on.
    pub fn active(&self, u: f64) -> (usize, Vec<f64>) {
        match *self {
            Self::Legendre { order } => (0, legendre(order, 2.0 * u - 1.0)),
            Self::Piecewise { segments } => {
                let segment = (u * segments as f64) as usize;
                (segment.min(segments - 1), vec![1.0])
            }
        }
    }
}

/// P_0 … P_order at x in [−1, 1], by Bonnet's recurrence (n+1) P_{n+1} = (2n+1) x P_n − n P_{n−1}.
pub fn legendre(order: usize, x: f64) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for n in 1..order {
        let k = n as f64;
        values.push(((2.0 * k + 1.0) * x * values[n] - k * values[n - 1]) / (k + 1.0));
    }
    values.truncate(order + 1);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the explicit polynomials up to order four.
    #[test]
    fn recurrence_gives_the_explicit_polynomials() {
        for x in [-1.0, -0.4, 0.0, 0.3, 1.0f64] {
            let explicit = [
                1.0,
                x,
                (3.0 * x * x - 1.0) / 2.0,
                (5.0 * x.powi(3) - 3.0 * x) / 2.0,
                (35.0 * x.powi(4) - 30.0 * x * x + 3.0) / 8.0,
            ];
            for (mine, theirs) in legendre(4, x).iter().zip(explicit) {
                assert!((mine - theirs).abs() < 1e-15);
            }
        }
    }

    /// Oracle: ∫ P_m P_n = 2/(2n+1) δ_mn, by the midpoint rule.
    #[test]
    fn polynomials_are_orthogonal() {
        let points = 20_000;
        let mut gram = [[0.0; 6]; 6];
        for i in 0..points {
            let p = legendre(5, (2.0 * f64::from(i) + 1.0) / f64::from(points) - 1.0);
            for m in 0..6 {
                for n in 0..6 {
                    gram[m][n] += p[m] * p[n] * 2.0 / f64::from(points);
                }
            }
        }
        for (m, row) in gram.iter().enumerate() {
            for (n, value) in row.iter().enumerate() {
                let expected = if m == n { 2.0 / (2 * n + 1) as f64 } else { 0.0 };
                assert!((value - expected).abs() < 1e-6, "{m} {n}: {value}");
            }
        }
    }

    #[test]
    fn segments_share_the_arm_equally() {
        let basis = StrainBasis::Piecewise { segments: 3 };
        let found: Vec<usize> = [0.0, 0.33, 0.34, 0.66, 0.67, 1.0].iter().map(|&u| basis.active(u).0).collect();
        assert_eq!(found, [0, 0, 1, 1, 2, 2]);
        assert_eq!(basis.borders().len(), 2);
    }

    #[test]
    fn reads_the_manifest_form_and_refuses_other_keys() {
        let read = |text: &str| serde_json::from_str::<StrainBasis>(text);
        let linear = read(r#"{"basis": "legendre", "order": 1}"#);
        assert_eq!(linear.ok(), Some(StrainBasis::Legendre { order: 1 }));
        assert!(read(r#"{"basis": "piecewise", "segments": 3, "order": 1}"#).is_err());
    }
}
