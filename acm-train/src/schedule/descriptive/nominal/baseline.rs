//! Comparison of models on the trials that they were fitted to, and on each trial left out in turn.
//!
//! | key            | model                                                        |
//! | -------------- | ------------------------------------------------------------ |
//! | `polynomial`   | from actuators straight to the tip                           |
//! | `strain`       | strain model: actuation map first, then strain parameters    |
//! | `strain_joint` | the same, followed by a fit of everything together; what the experiments use |
//!
//! Leave-one-trial-out asks what a model says of a trial that it has not seen. The trials at the border of the
//! workspace are then extrapolated to.

use acm_core::{ArmSpec, Calibration, CalibrationError, CalibrationOptions, NominalSpec, Observations, calibrate_with};
use acm_datasets::Trial;
use nalgebra::DMatrix;

use super::record::{Errors, ModelRow, TrialErrors};
use crate::{
    run::RunError,
    schedule::{
        descriptive::{base::Base, rms::Rms},
        error::ScheduleError,
        request::Request,
    },
};

/// One model with its predictions, one table per trial, [T×O].
pub struct Model {
    key: &'static str,
    label: String,
    calibration: Calibration,
    /// Predictions of the fit to all trials.
    pub fitted: Vec<DMatrix<f64>>,
    /// Predictions of the fits to the other trials.
    pub left_out: Option<Vec<DMatrix<f64>>>,
}

/// Fits the models to all `trials`, and to all but each.
///
/// # Errors
/// A fit to all trials is impossible, or the user stopped it.
pub fn study(
    trials: &[&Trial],
    base: &Base,
    arm: &ArmSpec,
    request: &Request,
    notes: &mut Vec<String>,
) -> Result<Vec<Model>, ScheduleError> {
    let degree = base.experiment.nominal.comparator_degree;
    let tip = base.campaign.tip_columns();
    let fitted = |trials: &[&Trial]| fits(arm, degree, &base.campaign.observations(trials));
    let predicted =
        |fit: &Calibration, trial: &Trial| fit.model.predict(&trial.actuators).columns_range(tip.clone()).into_owned();
    request.progress.note(&format!("strain and polynomial on {} trials", trials.len()));
    let names = || trials.iter().map(|trial| trial.name.as_str()).collect::<Vec<_>>().join(", ");
    let whole = fitted(trials).map_err(|source| RunError::Calibration { trials: names(), source })?;
    let mut left_out: Vec<Option<Vec<DMatrix<f64>>>> = vec![Some(vec![]); whole.len()];
    for (place, trial) in trials.iter().enumerate() {
        stop(request, place, trials.len())?;
        request.progress.note(&format!("without trial {}", trial.name));
        let others: Vec<&Trial> = trials.iter().copied().filter(|other| other.name != trial.name).collect();
        match fitted(&others) {
            Ok(fits) => {
                for (tables, fit) in left_out.iter_mut().zip(&fits) {
                    tables.iter_mut().for_each(|tables| tables.push(predicted(fit, trial)));
                }
            }
            Err(why) => {
                notes.push(format!("No error with trials left out: without trial {}, {why}.", trial.name));
                left_out.fill(None);
                break;
            }
        }
    }
    let model = |(((key, label), calibration), left_out): (((&'static str, String), Calibration), _)| Model {
        key,
        label,
        fitted: trials.iter().map(|trial| predicted(&calibration, trial)).collect(),
        calibration,
        left_out,
    };
    Ok(KEYS.into_iter().zip(labels(degree)).zip(whole).zip(left_out).map(model).collect())
}

const KEYS: [&str; 3] = ["polynomial", "strain", "strain_joint"];

fn labels(degree: usize) -> [String; 3] {
    [format!("Polynomial, degree {degree}"), "Strain, two steps".into(), "Strain, joint polish".into()]
}

/// Returns the fits in the order of [`KEYS`].
fn fits(arm: &ArmSpec, degree: usize, data: &Observations) -> Result<[Calibration; 3], CalibrationError> {
    let (joint, steps) = (CalibrationOptions::default(), CalibrationOptions { joint: false, ..Default::default() });
    let strain = NominalSpec::Strain(arm.clone());
    Ok([
        calibrate_with(&NominalSpec::Polynomial { degree }, data, &joint)?,
        calibrate_with(&strain, data, &steps)?,
        calibrate_with(&strain, data, &joint)?,
    ])
}

fn stop(request: &Request, finished: usize, planned: usize) -> Result<(), ScheduleError> {
    match request.stop.asked() {
        true => Err(ScheduleError::Stopped { folder: request.out.into(), finished, planned }),
        false => Ok(()),
    }
}

impl Model {
    /// Returns the start of the model's columns.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Returns the errors against what was `measured` in `trials`, [T×O] each.
    pub fn row(&self, trials: &[&Trial], measured: &[DMatrix<f64>]) -> ModelRow {
        let errors = |tables: &Vec<DMatrix<f64>>| {
            let each: Vec<DMatrix<f64>> = tables.iter().zip(measured).map(|(said, was)| said - was).collect();
            let named = |(error, trial): (&DMatrix<f64>, &&Trial)| TrialErrors {
                trial: trial.name.clone(),
                rms: Rms::of(error),
            };
            Errors { all: Rms::of_all(&each), trials: each.iter().zip(trials).map(named).collect() }
        };
        ModelRow {
            key: self.key.into(),
            label: self.label.clone(),
            parameters: self.calibration.parameters.clone(),
            stages: self.calibration.stages.clone(),
            fitted: errors(&self.fitted),
            left_out: self.left_out.as_ref().map(errors),
        }
    }
}
