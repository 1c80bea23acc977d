//! Precision of the calibration.
//!
//! ```text
//! Λ = JᵀJ / (4 σ_c² τ)
//! ```
//!
//! | symbol | meaning                                                                             | unit |
//! | `J`    | slopes of the weighted outputs with the calibrated parameters, calibration trials   |      |
//! | `σ_c²` | mean square of the residual in the calibration trials                               |      |
//! | `τ`    | integrated autocorrelation time of the residual, in samples                         | 1    |
//!
//! The 4 allows for systematic model error. Sokal (1997), Monte Carlo Methods in Statistical Mechanics, § 3.

use nalgebra::{DMatrix, DVectorView};

use super::trials::Trials;

/// Factor on the variances of white noise.
const INFLATION: f64 = 4.0;

/// Returns Λ from calibration trials, at their best fit; zero where there are none.
pub fn precision(calibration: &Trials) -> DMatrix<f64> {
    let (left, width) = (calibration.left(), calibration.prepared.weight.len());
    let power = left.norm_squared();
    let weighted = calibration.all.iter().map(|trial| {
        let own = left.rows(trial.rows.start, trial.rows.len());
        own.norm_squared() * correlation_time(&own, width)
    });
    let time = if power > 0.0 { (weighted.sum::<f64>() / power).max(1.0) } else { 1.0 };
    &calibration.normal / (INFLATION * calibration.noise.max(f64::MIN_POSITIVE) * time)
}

/// Computes the integrated autocorrelation time 1 + 2 Σ ρ_k until ρ falls below a twentieth; rows of `width` outputs.
fn correlation_time(residual: &DVectorView<f64>, width: usize) -> f64 {
    let samples = residual.len() / width.max(1);
    let power = residual.norm_squared();
    let correlation = |lag: usize| {
        let rows = (samples - lag) * width;
        let shifted = residual.rows(0, rows).dot(&residual.rows(lag * width, rows));
        if power > 0.0 { shifted / power } else { 0.0 }
    };
    1.0 + 2.0 * (1..samples / 3).map(correlation).take_while(|correlation| *correlation >= 0.05).sum::<f64>()
}
