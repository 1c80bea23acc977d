//! Share of an effect that recalibration imitates.
//!
//! ```text
//! δ = (JᵀJ + σ² f Λ)⁻¹ Jᵀ d,   f the smallest factor ≥ 1 for which δᵀ Λ δ ≤ χ²_99(P)
//! ```
//!
//! | symbol | meaning                                                     | shape |
//! | `J`    | slopes of the weighted outputs with the calibration         | NM × P |
//! | `d`    | what the effect does to them                                | NM    |
//! | `Λ`    | precision of the calibration ([`super::precision`]), σ² the variance of the noise | P × P |
//!
//! χ² after Wilson & Hilferty (1931), PNAS 17(12).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::trials::Trials;
use crate::tall::product;

/// Share of an effect that recalibration imitates; see the head of this file.
#[derive(Debug, Clone)]
pub struct Recalibration {
    /// Share of the effect's mean square that recalibration absorbs.
    pub share: f64,
    /// Squared norm ‖d‖².
    pub whole: f64,
    /// Products Jᵀ d.
    pub along: DVector<f64>,
    /// Prior σ² f Λ, with a ridge for directions that the data do not determine.
    prior: DMatrix<f64>,
    factor: Option<Cholesky<f64, Dyn>>,
}

/// Ridge that fixes directions that the data do not determine.
const RIDGE: f64 = 1e-9;

impl Recalibration {
    /// Computes the recalibration for the displacement of all trials; `precision` is Λ.
    pub fn new(trials: &Trials, precision: &DMatrix<f64>, displacement: &DVector<f64>) -> Self {
        let along = trials.by_parameter.tr_mul(displacement);
        let whole = displacement.norm_squared();
        let limit = chi_square_99(trials.calibrated() as f64);
        let with = |half_decades: i32| {
            let factor = trials.noise * 10f64.powf(0.5 * f64::from(half_decades));
            Self::with(precision * factor, &trials.normal, along.clone(), whole)
        };
        let inside = |by: &Self| {
            let delta = by.solve(&along);
            delta.dot(&(precision * &delta)) <= limit
        };
        let by = (0..16).map(with).find(inside).unwrap_or_else(|| with(16));
        let delta = by.solve(&along);
        let left = whole - 2.0 * delta.dot(&along) + delta.dot(&(&trials.normal * &delta));
        Self { share: if whole > 0.0 { (1.0 - left / whole).clamp(0.0, 1.0) } else { 0.0 }, ..by }
    }

    fn with(mut prior: DMatrix<f64>, normal: &DMatrix<f64>, along: DVector<f64>, whole: f64) -> Self {
        let sizes = (normal + &prior).diagonal().map(|x| RIDGE * x.max(f64::MIN_POSITIVE));
        prior.set_diagonal(&(prior.diagonal() + sizes));
        let factor = (normal + &prior).cholesky();
        Self { share: 0.0, whole, along, prior, factor }
    }

    /// Computes (JᵀJ + σ² f Λ)⁻¹ x; nothing where the model has nothing to calibrate.
    pub fn solve(&self, x: &DVector<f64>) -> DVector<f64> {
        self.factor.as_ref().map_or_else(|| DVector::zeros(x.len()), |factor| factor.solve(x))
    }

    /// Computes the solutions for several right-hand sides.
    pub fn solve_all(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        self.factor.as_ref().map_or_else(|| DMatrix::zeros(x.nrows(), x.ncols()), |factor| factor.solve(x))
    }

    /// Computes δᵀ σ² f Λ δ.
    pub fn pull(&self, delta: &DVector<f64>) -> f64 {
        delta.dot(&(&self.prior * delta))
    }

    /// Returns the remainder of each column when the best δ is taken out, and the prior's part below it: (NM + P) rows
    /// whose sum of squares is min over δ of ‖x − J δ‖² + δᵀ σ² f Λ δ.
    pub fn without(&self, trials: &Trials, columns: &DMatrix<f64>) -> DMatrix<f64> {
        if trials.calibrated() == 0 {
            return columns.clone();
        }
        let rows = trials.rows();
        let delta = self.solve_all(&product(&trials.by_parameter, columns, 0..rows));
        let mut left = columns.clone().resize_vertically(rows + trials.calibrated(), 0.0);
        left.rows_mut(0, rows).gemm(-1.0, &trials.by_parameter, &delta, 1.0);
        if let Some(factor) = self.prior.clone().cholesky() {
            left.rows_mut(rows, trials.calibrated()).copy_from(&factor.l().tr_mul(&delta));
        }
        left
    }
}

fn chi_square_99(freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom.max(1.0));
    freedom * (1.0 - spread + 2.326_347_9 * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::chi_square_99;

    /// Oracle: tables of χ².
    #[test]
    fn quantiles_of_chi_square() {
        assert!((chi_square_99(5.0) / 15.086 - 1.0).abs() < 0.01);
        assert!((chi_square_99(20.0) / 37.566 - 1.0).abs() < 0.01);
    }
}
