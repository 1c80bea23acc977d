//! What recalibration alone makes of an effect.
//!
//! ```text
//! δ = (JᵀJ + σ² f Λ)⁻¹ Jᵀ d,   f the smallest factor ≥ 1 for which δᵀ Λ δ ≤ χ²_99(P)
//! ```
//!
//! | symbol | meaning                                                     | shape |
//! | `J`    | slopes of the weighted outputs with the calibration         | NM × P |
//! | `d`    | what the effect does to them                                | NM    |
//! | `Λ`    | precision of the calibration, σ² the variance of the noise  | P × P |
//!
//! χ² after Wilson & Hilferty (1931), PNAS 17(12).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::separability::setup::Setup;

/// See the head of this file.
#[derive(Debug, Clone)]
pub struct Recalibration {
    /// f Λ.
    pub precision: DMatrix<f64>,
    /// Share of the effect's mean square that it takes over.
    pub share: f64,
    /// ‖d‖².
    pub whole: f64,
    /// Jᵀ d.
    pub along: DVector<f64>,
    /// σ² f Λ.
    prior: DMatrix<f64>,
    factor: Option<Cholesky<f64, Dyn>>,
}

/// Directions that the data do not determine stay where they are.
const RIDGE: f64 = 1e-9;

impl Recalibration {
    /// For the displacement of every trial.
    pub fn new(setup: &Setup, displacement: &[DVector<f64>]) -> Self {
        let free = setup.calibrated();
        let mut normal = DMatrix::zeros(free, free);
        setup.references.iter().flat_map(|reference| &reference.normal).for_each(|part| normal += part);
        let along = along(setup, displacement);
        let whole: f64 = displacement.iter().map(DVector::norm_squared).sum();
        let limit = chi_square_99(free as f64);
        let mut last = Self::with(&setup.precision, setup.noise, &normal, along.clone(), whole);
        for half_decades in 1..=16 {
            let delta = last.solve(&along);
            if delta.dot(&(&setup.precision * &delta)) <= limit {
                break;
            }
            let factor = 10f64.powf(0.5 * f64::from(half_decades));
            last = Self::with(&(&setup.precision * factor), setup.noise, &normal, along.clone(), whole);
        }
        let delta = last.solve(&along);
        let left = whole - 2.0 * delta.dot(&along) + delta.dot(&(&normal * &delta));
        last.share = if whole > 0.0 { (1.0 - left / whole).clamp(0.0, 1.0) } else { 0.0 };
        last
    }

    fn with(precision: &DMatrix<f64>, noise: f64, normal: &DMatrix<f64>, along: DVector<f64>, whole: f64) -> Self {
        let prior = precision * noise;
        let mut sum = normal + &prior;
        let diagonal = sum.diagonal().map(|x| RIDGE * x.max(f64::MIN_POSITIVE));
        sum.set_diagonal(&(sum.diagonal() + diagonal));
        Self { precision: precision.clone(), share: 0.0, whole, along, prior, factor: sum.cholesky() }
    }

    /// (JᵀJ + σ² f Λ)⁻¹ x; nothing where the model has nothing to calibrate.
    pub fn solve(&self, x: &DVector<f64>) -> DVector<f64> {
        self.factor.as_ref().map_or_else(|| DVector::zeros(x.len()), |factor| factor.solve(x))
    }

    /// The same for several.
    pub fn solve_all(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        self.factor.as_ref().map_or_else(|| DMatrix::zeros(x.nrows(), x.ncols()), |factor| factor.solve(x))
    }

    /// δᵀ σ² f Λ δ.
    pub fn pull(&self, delta: &DVector<f64>) -> f64 {
        delta.dot(&(&self.prior * delta))
    }
}

/// Jᵀ d; the setup holds −J, the slopes of the residual.
pub fn along(setup: &Setup, displacement: &[DVector<f64>]) -> DVector<f64> {
    let mut along = DVector::zeros(setup.calibrated());
    for (reference, trial) in setup.references.iter().zip(displacement) {
        along -= reference.by_parameter.tr_mul(trial);
    }
    along
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
