//! The nominal model and its comparator, calibrated before any network is trained and fixed from then on.
//!
//! | data                              | nominal model is calibrated on                     |
//! | --------------------------------- | -------------------------------------------------- |
//! | with calibration trials           | those, once                                        |
//! | without                           | the training trials of each fold, once per fold    |
//! | own `[[predicted]]` columns, no `[arm]` | nothing: those columns are the prediction    |
//! | with `nominal.augmented`          | nothing: the saved model predicts ([`crate::augmented`]) |
//!
//! Held-out trials are never calibrated on.

use std::collections::BTreeMap;

use acm_core::{ArmSpec, Calibration, NominalSpec, calibrate};
use acm_datasets::{Campaign, Role, Trial};
use nalgebra::DMatrix;

use crate::{
    error::TrainError,
    experiment::{Nominal, NominalKind, Source},
    plan::Plan,
    record::{CalibrationPair, DataStamp, FORMAT, NominalRecord, NominalSource},
};

/// What is to be calibrated.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    source: NominalSource,
    /// `None` where the data or a saved model bring the prediction.
    spec: Option<NominalSpec>,
    comparator: NominalSpec,
}

impl Choice {
    /// What is calibrated; `None` where the prediction comes with the data.
    pub fn spec(&self) -> Option<&NominalSpec> {
        self.spec.as_ref()
    }
}

/// What the experiment asks for, or else what the manifest describes.
///
/// # Errors
/// The experiment asks for a model that the data cannot have.
pub fn choose(nominal: &Nominal, source: &Source, campaign: &Campaign) -> Result<Choice, TrainError> {
    let comparator = NominalSpec::Polynomial { degree: nominal.comparator_degree };
    if nominal.augmented.is_some() {
        return Ok(Choice { source: NominalSource::Augmented, spec: None, comparator });
    }
    let kind = kind(nominal, campaign);
    let spec = spec(kind, nominal, source, campaign)?;
    Ok(Choice { source: origin(kind, campaign), spec, comparator })
}

/// Calibrates everything that the plans need.
///
/// # Errors
/// A fit is impossible.
pub fn calibrations(
    choice: &Choice,
    campaign: &Campaign,
    plans: &[Plan],
    data: DataStamp,
) -> Result<NominalRecord, TrainError> {
    let groups: BTreeMap<String, Vec<String>> =
        plans.iter().map(|plan| (group(campaign, plan), trials_of(campaign, plan))).collect();
    let pair = |trials: Vec<String>| -> Result<CalibrationPair, TrainError> {
        let nominal = choice.spec.as_ref().map(|spec| fit(spec, campaign, &trials)).transpose()?;
        Ok(CalibrationPair { nominal, polynomial: fit(&choice.comparator, campaign, &trials)?, trials })
    };
    let calibrations =
        groups.into_iter().map(|(group, trials)| Ok((group, pair(trials)?))).collect::<Result<_, TrainError>>()?;
    Ok(NominalRecord { format: FORMAT, data, source: choice.source, calibrations })
}

/// The group of calibrations that a plan uses: `calibration`, or its fold's own.
pub fn group(campaign: &Campaign, plan: &Plan) -> String {
    if has_calibration_trials(campaign) { "calibration".into() } else { format!("fold{}", plan.fold) }
}

/// Nominal prediction and comparator of a trial, [T×M] each.
pub fn predict(pair: &CalibrationPair, trial: &Trial) -> (DMatrix<f64>, DMatrix<f64>) {
    let nominal = match (&pair.nominal, &trial.predicted) {
        (Some(fitted), _) => fitted.model.predict(&trial.actuators),
        (None, Some(own)) => own.clone(),
        (None, None) => DMatrix::zeros(trial.measured.nrows(), trial.measured.ncols()),
    };
    (nominal, pair.polynomial.model.predict(&trial.actuators))
}

fn has_calibration_trials(campaign: &Campaign) -> bool {
    campaign.trials(Role::Calibration).next().is_some()
}

fn trials_of(campaign: &Campaign, plan: &Plan) -> Vec<String> {
    if has_calibration_trials(campaign) {
        campaign.trials(Role::Calibration).map(|trial| trial.name.clone()).collect()
    } else {
        plan.split.training.clone()
    }
}

fn kind(nominal: &Nominal, campaign: &Campaign) -> NominalKind {
    let has_arm = campaign.manifest.arm.is_some();
    let own = !campaign.manifest.predicted.is_empty();
    nominal.model.unwrap_or(match (has_arm, own) {
        (true, _) => NominalKind::Strain,
        (false, true) => NominalKind::Predicted,
        (false, false) => NominalKind::Polynomial,
    })
}

fn origin(kind: NominalKind, campaign: &Campaign) -> NominalSource {
    match kind {
        NominalKind::Predicted => NominalSource::Predicted,
        NominalKind::None => NominalSource::None,
        _ if has_calibration_trials(campaign) => NominalSource::CalibrationTrials,
        _ => NominalSource::TrainingTrials,
    }
}

/// What is to be calibrated; `None` where the data bring the prediction.
fn spec(
    kind: NominalKind,
    nominal: &Nominal,
    source: &Source,
    campaign: &Campaign,
) -> Result<Option<NominalSpec>, TrainError> {
    let refuse = |what: String, help: &str| {
        let key = ["nominal".to_string(), "model".to_string()];
        Err(TrainError::from(Box::new(source.complaint(&key, what, help))))
    };
    match (kind, campaign.nominal_spec()) {
        (NominalKind::Strain, NominalSpec::Strain(arm)) => {
            let arm = overridden(arm, nominal);
            match arm.validate() {
                Ok(()) => Ok(Some(NominalSpec::Strain(arm))),
                Err(error) => {
                    refuse(format!("[nominal]: {error}"), "mend the value, or leave it out for the manifest's")
                }
            }
        }
        (NominalKind::Strain, _) => refuse(
            format!("`nominal.model` is \"strain\", and the manifest of {} describes no [arm]", campaign.manifest.name),
            "describe the arm in the manifest, or write model = \"polynomial\"",
        ),
        (NominalKind::Predicted, _) if campaign.manifest.predicted.is_empty() => refuse(
            format!(
                "`nominal.model` is \"predicted\", and the data {} have no [[predicted]] columns",
                campaign.manifest.name
            ),
            "list the columns in the manifest, or write model = \"polynomial\"",
        ),
        (NominalKind::Predicted, _) => Ok(None),
        (NominalKind::Polynomial, _) => Ok(Some(NominalSpec::Polynomial { degree: nominal.degree.unwrap_or(3) })),
        (NominalKind::None, _) => Ok(Some(NominalSpec::None)),
    }
}

fn overridden(arm: ArmSpec, nominal: &Nominal) -> ArmSpec {
    ArmSpec {
        length: nominal.length.unwrap_or(arm.length),
        axis: nominal.axis.unwrap_or(arm.axis),
        strain: nominal.strain.unwrap_or(arm.strain),
        degree: nominal.degree.unwrap_or(arm.degree),
        steps: nominal.steps.unwrap_or(arm.steps),
        tolerance: nominal.tolerance.or(arm.tolerance),
        ..arm
    }
}

pub(crate) fn fit(spec: &NominalSpec, campaign: &Campaign, names: &[String]) -> Result<Calibration, TrainError> {
    let trials: Vec<&Trial> = campaign.trials.iter().filter(|trial| names.contains(&trial.name)).collect();
    calibrate(spec, &campaign.observations(&trials))
        .map_err(|source| TrainError::Calibration { trials: names.join(", "), source })
}
