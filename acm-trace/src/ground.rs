//! The nominal model before any effect: calibrated, with its static map, and with how well the calibration is known.
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

use acm_core::calibration::{CalibrationError, calibrate};
use acm_core::nominal::{NominalModel, NominalSpec};
use acm_core::observations::Observations;
use acm_core::polynomial::Polynomial;
use acm_core::response::Response;
use acm_core::static_map::{Discrepancy, StaticMap};
use nalgebra::{DMatrix, DVector};

use crate::case::{Case, Trial};
use crate::evaluate::{self, Point, StateFrom, Tip};
use crate::series::Series;
use crate::setup::Setup;

/// Samples that the nominal model is calibrated on.
const CALIBRATED_SAMPLES: usize = 3000;

/// Degree of the polynomial that stands for a prediction that comes with the data.
const STANDING_DEGREE: usize = 3;

/// Most coefficients of it for each output.
const STANDING_TERMS: usize = 40;

/// How much wider than white noise says.
const INFLATION: f64 = 4.0;

/// Calibrates the nominal model on `trials`; or fits the polynomial that stands for predictions that come with the data, and
/// stores what it leaves of them in every trial of the case.
///
/// # Errors
/// A calibration that is impossible.
pub fn calibrate_nominal(case: &mut Case) -> Result<Nominal, CalibrationError> {
    if case.is_predicted() {
        return stand_in(case);
    }
    let trials = if case.calibration.is_empty() { &case.development } else { &case.calibration };
    let observations = observations(trials, &case.at, |trial| &trial.measured);
    let model = calibrate(&case.nominal, &thinned(observations))?.model;
    Ok(Nominal { model, stands_for: None })
}

/// A calibrated nominal model.
#[derive(Debug, Clone)]
pub struct Nominal {
    /// Ready to predict.
    pub model: NominalModel,
    /// The polynomial g where the prediction comes with the data.
    pub stands_for: Option<Polynomial>,
}

fn stand_in(case: &mut Case) -> Result<Nominal, CalibrationError> {
    let actuators = case.rig.actuators.len();
    let terms = |degree| 1 + acm_core::actuation::monomial_count(actuators, degree);
    let degree = (1..=STANDING_DEGREE).rev().find(|&degree| terms(degree) <= STANDING_TERMS).unwrap_or(1);
    let known: Vec<Trial> = case.calibration.iter().chain(&case.development).cloned().collect();
    let all = observations(&known, &[], |trial| trial.predicted.as_ref().unwrap_or(&trial.measured));
    let spec = NominalSpec::Polynomial { degree };
    let model = calibrate(&spec, &thinned(all))?.model;
    let NominalModel::Polynomial(g) = model.clone() else { return Ok(Nominal { model, stands_for: None }) };
    let trials = case.calibration.iter_mut().chain(&mut case.development).chain(&mut case.untouched);
    for trial in trials {
        let q = actuators_of(trial);
        trial.offset = trial.predicted.as_ref().map(|own| own - g.predict(&q));
    }
    Ok(Nominal { model, stands_for: Some(g) })
}

/// N × A.
fn actuators_of(trial: &Trial) -> DMatrix<f64> {
    let columns = &trial.record.actuators;
    DMatrix::from_fn(trial.record.samples(), columns.len(), |t, a| columns[a][t])
}

fn observations(trials: &[Trial], at: &[f64], outputs: impl Fn(&Trial) -> &DMatrix<f64>) -> Observations {
    let stack = |parts: Vec<DMatrix<f64>>| {
        let (rows, columns) = (parts.iter().map(DMatrix::nrows).sum(), parts.first().map_or(0, DMatrix::ncols));
        let mut all = DMatrix::zeros(rows, columns);
        let mut start = 0;
        for part in parts {
            all.rows_mut(start, part.nrows()).copy_from(&part);
            start += part.nrows();
        }
        all
    };
    Observations {
        actuators: stack(trials.iter().map(actuators_of).collect()),
        measured: stack(trials.iter().map(|trial| outputs(trial).clone()).collect()),
        at: at.to_vec(),
    }
}

fn thinned(all: Observations) -> Observations {
    let stride = all.actuators.nrows().div_ceil(CALIBRATED_SAMPLES).max(1);
    let rows: Vec<usize> = (0..all.actuators.nrows()).step_by(stride).collect();
    Observations { actuators: all.actuators.select_rows(&rows), measured: all.measured.select_rows(&rows), at: all.at }
}

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
