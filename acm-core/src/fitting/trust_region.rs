//! The linear problem inside a trust region, solved through its singular values.
//!
//! ```text
//! minimise ‖z + R p‖² with ‖D p‖ ≤ Δ:   R D⁻¹ = U S Vᵀ,   p = −D⁻¹ V S (S² + μ)⁻¹ Uᵀ z
//! ```
//!
//! μ = 0 where the whole step fits into the region; otherwise μ is the one that makes it as long as Δ.

use nalgebra::{DMatrix, DVector};

use crate::fitting::least_squares::Reduced;

/// A parameter without any influence so far counts with weight one.
pub(crate) fn weight(scale: f64) -> f64 {
    if scale > 0.0 { scale } else { 1.0 }
}

/// R D⁻¹ = U S Vᵀ over the free parameters.
pub(crate) struct Linear {
    weights: Vec<f64>,
    singular: DVector<f64>,
    v: DMatrix<f64>,
    /// −Uᵀ z.
    right: DVector<f64>,
}

impl Linear {
    pub fn new(here: &Reduced, scale: &[f64], free: &[usize]) -> Self {
        let weights: Vec<f64> = free.iter().map(|&j| weight(scale[j])).collect();
        let n = here.triangle.nrows();
        let scaled = DMatrix::from_fn(n, free.len(), |i, a| here.triangle[(i, free[a])] / weights[a]);
        let svd = scaled.svd(true, true);
        let (u, v) =
            (svd.u.unwrap_or_else(|| DMatrix::zeros(n, 0)), svd.v_t.unwrap_or_else(|| DMatrix::zeros(0, free.len())));
        Self { weights, right: -(u.tr_mul(&here.right)), singular: svd.singular_values, v: v.transpose() }
    }

    /// Singular values below this are rounding.
    fn smallest(&self) -> f64 {
        let largest = self.singular.iter().copied().fold(0.0, f64::max);
        largest * f64::EPSILON * self.singular.len() as f64
    }

    /// Step within the region, and whether it is the whole Gauss–Newton step.
    pub fn step(&self, radius: f64) -> (Vec<f64>, bool) {
        let whole = self.damped(0.0);
        if whole.norm() <= 1.1 * radius {
            return (self.unscale(&whole), true);
        }
        let damping = self.damping(radius);
        (self.unscale(&self.damped(damping)), false)
    }

    /// Coordinates of the step along the singular directions: s b/(s² + μ).
    fn damped(&self, damping: f64) -> DVector<f64> {
        let smallest = self.smallest();
        self.singular.zip_map(&self.right, |s, b| if s > smallest { s * b / (s * s + damping) } else { 0.0 })
    }

    /// The μ ≥ 0 whose step is as long as the radius, within a tenth: Newton on 1/‖·‖, which
    /// approaches from below without overshoot.
    fn damping(&self, radius: f64) -> f64 {
        let mut damping = 0.0;
        for _ in 0..100 {
            let step = self.damped(damping);
            let length = step.norm();
            if length <= 1.1 * radius {
                break;
            }
            let slope: f64 = step
                .iter()
                .zip(self.singular.iter())
                .filter(|(y, _)| **y != 0.0)
                .map(|(y, s)| y * y / (s * s + damping))
                .sum();
            damping += (length / radius - 1.0) * length * length / slope;
        }
        damping
    }

    fn unscale(&self, along: &DVector<f64>) -> Vec<f64> {
        let step = &self.v * along;
        step.iter().zip(&self.weights).map(|(y, d)| y / d).collect()
    }

    /// (JᵀJ)⁻¹ of the free parameters; NaN for those that the data do not determine.
    pub fn inverse_normal(&self) -> DMatrix<f64> {
        let smallest = self.smallest();
        let known: Vec<usize> = (0..self.singular.len()).filter(|&k| self.singular[k] > smallest).collect();
        let n = self.weights.len();
        let determined: Vec<bool> = (0..n)
            .map(|j| {
                let seen: f64 = known.iter().map(|&k| self.v[(j, k)].powi(2)).sum();
                (seen - 1.0).abs() < 1e-6
            })
            .collect();
        DMatrix::from_fn(n, n, |i, j| {
            if !(determined[i] && determined[j]) {
                return f64::NAN;
            }
            let sum: f64 = known.iter().map(|&k| self.v[(i, k)] * self.v[(j, k)] / self.singular[k].powi(2)).sum();
            sum / (self.weights[i] * self.weights[j])
        })
    }
}
