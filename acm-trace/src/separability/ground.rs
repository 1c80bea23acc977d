//! The calibrated model around some trials: its static map, and how well the calibration is known.
//!
//! ```text
//! Λ = JᵀJ / (4 σ_c² τ)
//! ```
//!
//! | symbol | meaning                                                                             | unit |
//! | `J`    | slopes of the outputs with respect to the calibrated parameters, calibration trials |      |
//! | `σ_c²` | mean square of what is left in the calibration trials                               |      |
//! | `τ`    | samples in a row that say the same: integrated autocorrelation of what is left      | 1    |
//!
//! The 4 allows for model error that repeats itself. Sokal (1997), Monte Carlo Methods in Statistical Mechanics, § 3.

use acm_core::response::Response;
use acm_core::static_map::{Discrepancy, StaticMap};
use nalgebra::{DMatrix, DVector};

use super::evaluate::{self, Point, StateFrom, Tip};
use super::setup::Setup;
use crate::case::Case;
use crate::series::Series;

/// How much wider than white noise says.
const INFLATION: f64 = 4.0;

/// Static map of what `setup` leaves in its trials, effects of `point` included, in units of the outputs.
pub fn static_map(setup: &Setup, point: Point) -> Option<StaticMap> {
    common_map(&[(setup, point)])
}

/// One static map of what several models leave, each in its own trials.
pub fn common_map(models: &[(&Setup, Point)]) -> Option<StaticMap> {
    let (mut q, mut residual, mut block, mut trial) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut number = 0;
    for (setup, point) in models {
        let width = setup.outputs();
        for (s, (series, reference)) in setup.series.iter().zip(&setup.references).enumerate() {
            let outputs = evaluate::outputs(setup, s, *point, Tip::Exact);
            for k in (0..series.samples()).filter(|&k| series.counts[k]) {
                q.extend(reference.q.iter().map(|q| q[series.rows[k]]));
                residual.extend((0..width).map(|o| series.measured[k * width + o] - outputs[k * width + o]));
                // Parts of a trial are left out, so that the map is judged where the others have been.
                block.push(8 * number + 8 * k / series.samples());
                trial.push(number);
            }
            number += 1;
        }
    }
    let (samples, setup) = (block.len(), models.first()?.0);
    let actuators = DMatrix::from_row_slice(samples, setup.rig.actuators.len(), &q);
    let residual = DMatrix::from_row_slice(samples, setup.outputs(), &residual);
    StaticMap::learn(Discrepancy { actuators: &actuators, residual: &residual, block: &block, trial: &trial })
}

/// Λ from calibration trials, at their best fit.
pub fn precision(setup: &Setup, point: Point) -> DMatrix<f64> {
    let calibrated = setup.calibrated();
    let mut normal = DMatrix::zeros(calibrated, calibrated);
    let (mut squares, mut count, mut weighted_time) = (0.0, 0usize, 0.0);
    for s in 0..setup.series.len() {
        let residual = evaluate::residual(setup, s, point, Tip::Exact, StateFrom::Trial);
        setup.references[s].normal.iter().for_each(|part| normal += part);
        let samples = setup.series[s].counts.iter().filter(|counts| **counts).count() * setup.outputs();
        squares += residual.norm_squared();
        weighted_time += residual.norm_squared() * correlation_time(&residual, setup.outputs());
        count += samples;
    }
    let variance = squares / count.max(1) as f64;
    let time = if squares > 0.0 { (weighted_time / squares).max(1.0) } else { 1.0 };
    normal / (INFLATION * variance.max(f64::MIN_POSITIVE) * time)
}

/// 1 + 2 Σ ρ_k until ρ falls below a twentieth; rows of `width` outputs.
fn correlation_time(residual: &DVector<f64>, width: usize) -> f64 {
    let samples = residual.len() / width.max(1);
    let mut sum = 1.0;
    let power = residual.norm_squared();
    for lag in 1..samples / 3 {
        let shifted =
            residual.rows(0, (samples - lag) * width).dot(&residual.rows(lag * width, (samples - lag) * width));
        let correlation = if power > 0.0 { shifted / power } else { 0.0 };
        if correlation < 0.05 {
            break;
        }
        sum += 2.0 * correlation;
    }
    sum
}

/// A response and its setup on some trials, without effects.
pub fn bare<'a>(case: &'a Case, series: &'a [Series], response: Response, weight: &[f64], noise: f64) -> Setup<'a> {
    let calibrated = response.parameters().len();
    let prior = (DMatrix::zeros(calibrated, calibrated), DVector::zeros(calibrated));
    Setup::new(&case.rig, series, response, &[], &[], weight.to_vec(), noise, prior)
}
