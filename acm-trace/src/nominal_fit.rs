//! Calibration of the nominal model before any effect, and the polynomial that approximates it where inputs change.

use acm_core::calibration::{CalibrationError, calibrate};
use acm_core::completed;
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

/// Calibrates the nominal model on the calibration trials; `is_open` if they leave part of it undetermined. Where predictions come with
/// the data, it fits a polynomial to them, and stores the difference in every trial of the case.
///
/// # Errors
/// A calibration that is impossible.
pub fn calibrate_nominal(case: &mut Case, is_open: bool) -> Result<Nominal, CalibrationError> {
    if case.is_predicted() {
        return stand_in(case);
    }
    let trials = if case.calibration.is_empty() { &case.development } else { &case.calibration };
    let observations = thinned(measured(observations(trials, &case.at, |trial| &trial.measured)));
    let model = calibrate(&case.nominal, &observations)?.model;
    let completed = completion(&model, &observations, case, is_open);
    let in_use = completed.as_ref().unwrap_or(&model);
    let stand_in = matches!(model, NominalModel::Strain(_)).then(|| stand_in_for(in_use, case));
    Ok(Nominal { model, completed, stands_for: None, stand_in })
}

/// Returns a strain model completed from the development trials; none where they calibrate. Where the calibration trials do not determine
/// it, the fit also starts from a calibration to all trials.
fn completion(model: &NominalModel, calibration: &Observations, case: &Case, is_open: bool) -> Option<NominalModel> {
    let NominalModel::Strain(strain) = model else { return None };
    if case.calibration.is_empty() {
        return None;
    }
    let of = |trials: &[Trial]| thinned(measured(observations(trials, &case.at, |trial| &trial.measured)));
    let alike = || calibrate(&case.nominal, &of(&[case.calibration.clone(), case.development.clone()].concat())).ok();
    let alike = if is_open { alike().map(|all| all.model) } else { None };
    let alike = match &alike {
        Some(NominalModel::Strain(alike)) => Some(alike),
        _ => None,
    };
    Some(NominalModel::Strain(completed(strain, calibration, &of(&case.development), alike)))
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
    /// Model as calibrated.
    pub model: NominalModel,
    /// A strain model completed from the development trials ([`completed`]).
    pub completed: Option<NominalModel>,
    /// The polynomial g where the prediction comes with the data.
    pub stands_for: Option<Polynomial>,
    /// Polynomial that approximates a strain model.
    pub stand_in: Option<Polynomial>,
}

impl Nominal {
    /// Returns the model to which effects are added: completed where possible.
    pub fn in_use(&self) -> &NominalModel {
        self.completed.as_ref().unwrap_or(&self.model)
    }
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
        return Ok(Nominal { model, completed: None, stands_for: None, stand_in: None });
    };
    let trials = case.calibration.iter_mut().chain(&mut case.development);
    for trial in trials {
        let q = actuators_of(trial);
        trial.offset = trial.predicted.as_ref().map(|own| own - g.predict(&q));
    }
    Ok(Nominal { model, completed: None, stands_for: Some(g), stand_in: None })
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

/// Returns the samples at which everything was measured.
fn measured(all: Observations) -> Observations {
    let is_whole = |t: &usize| all.measured.row(*t).iter().all(|y| y.is_finite());
    let rows: Vec<usize> = (0..all.samples()).filter(is_whole).collect();
    Observations { actuators: all.actuators.select_rows(&rows), measured: all.measured.select_rows(&rows), at: all.at }
}

fn thinned(all: Observations) -> Observations {
    let stride = all.actuators.nrows().div_ceil(CALIBRATED_SAMPLES).max(1);
    let rows: Vec<usize> = (0..all.actuators.nrows()).step_by(stride).collect();
    Observations { actuators: all.actuators.select_rows(&rows), measured: all.measured.select_rows(&rows), at: all.at }
}
