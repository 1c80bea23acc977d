//! Calibration of the nominal model before any effect, and the polynomial that approximates it where inputs are moved.

use acm_core::calibration::{CalibrationError, calibrate};
use acm_core::nominal::{NominalModel, NominalSpec};
use acm_core::observations::Observations;
use acm_core::polynomial::Polynomial;
use nalgebra::DMatrix;

use crate::case::{Case, Trial};

/// Samples that the nominal model is calibrated on.
const CALIBRATED_SAMPLES: usize = 3000;

/// Degree of the polynomial that approximates a prediction that comes with the data.
const STANDING_DEGREE: usize = 3;

/// Largest number of the polynomial's coefficients for each output.
const STANDING_TERMS: usize = 40;

/// Calibrates the nominal model on `trials`. Where predictions come with the data, it fits a polynomial to them, and
/// stores the difference in every trial of the case.
///
/// # Errors
/// A calibration that is impossible.
pub fn calibrate_nominal(case: &mut Case) -> Result<Nominal, CalibrationError> {
    if case.is_predicted() {
        return stand_in(case);
    }
    let trials = if case.calibration.is_empty() { &case.development } else { &case.calibration };
    let observations = thinned(observations(trials, &case.at, |trial| &trial.measured));
    let model = calibrate(&case.nominal, &observations)?.model;
    let stand_in = matches!(model, NominalModel::Strain(_)).then(|| stand_in_for(&model, case));
    Ok(Nominal { model, stands_for: None, stand_in })
}

/// Highest degree of the polynomial that approximates a strain model, and largest number of its coefficients.
const STRAIN_DEGREE: (usize, usize) = (6, 90);

/// Points of the actuators' box that it is fitted to.
const BOX_POINTS: usize = 3000;

/// Margin of the box beyond the recorded range, as a share of the range.
const MARGIN: f64 = 0.05;

/// Returns a polynomial that approximates a strain model where inputs are changed. The difference to the model is
/// stored in every trial.
fn stand_in_for(model: &NominalModel, case: &mut Case) -> Polynomial {
    let actuators = &case.rig.actuators;
    let terms = |degree| 1 + acm_core::actuation::monomial_count(actuators.len(), degree);
    let degree = (1..=STRAIN_DEGREE.0).rev().find(|&degree| terms(degree) <= STRAIN_DEGREE.1).unwrap_or(1);
    // Halton points fill the box evenly.
    let point = |k: usize, a: usize| {
        let (low, span) = (actuators[a].low, actuators[a].span());
        low - MARGIN * span + (1.0 + 2.0 * MARGIN) * span * radical_inverse(k + 1, PRIMES[a % PRIMES.len()])
    };
    let q = DMatrix::from_fn(BOX_POINTS, actuators.len(), point);
    let g = Polynomial::fit(&q, &model.predict(&q), degree).polynomial;
    for trial in case.calibration.iter_mut().chain(&mut case.development) {
        let q = actuators_of(trial);
        trial.offset = Some(model.predict(&q) - g.predict(&q));
    }
    g
}

/// Bases of the Halton points.
const PRIMES: [usize; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

fn radical_inverse(mut k: usize, base: usize) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / base as f64);
    while k > 0 {
        value += digit * (k % base) as f64;
        k /= base;
        digit /= base as f64;
    }
    value
}

/// A calibrated nominal model.
#[derive(Debug, Clone)]
pub struct Nominal {
    /// Model that is ready to predict.
    pub model: NominalModel,
    /// The polynomial g where the prediction comes with the data.
    pub stands_for: Option<Polynomial>,
    /// Polynomial that approximates a strain model.
    pub stand_in: Option<Polynomial>,
}

fn stand_in(case: &mut Case) -> Result<Nominal, CalibrationError> {
    let actuators = case.rig.actuators.len();
    let terms = |degree| 1 + acm_core::actuation::monomial_count(actuators, degree);
    let degree = (1..=STANDING_DEGREE).rev().find(|&degree| terms(degree) <= STANDING_TERMS).unwrap_or(1);
    let known: Vec<Trial> = case.calibration.iter().chain(&case.development).cloned().collect();
    let all = observations(&known, &[], |trial| trial.predicted.as_ref().unwrap_or(&trial.measured));
    let spec = NominalSpec::Polynomial { degree };
    let model = calibrate(&spec, &thinned(all))?.model;
    let NominalModel::Polynomial(g) = model.clone() else {
        return Ok(Nominal { model, stands_for: None, stand_in: None });
    };
    let trials = case.calibration.iter_mut().chain(&mut case.development);
    for trial in trials {
        let q = actuators_of(trial);
        trial.offset = trial.predicted.as_ref().map(|own| own - g.predict(&q));
    }
    Ok(Nominal { model, stands_for: Some(g), stand_in: None })
}

/// Returns the actuators, N × A.
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
