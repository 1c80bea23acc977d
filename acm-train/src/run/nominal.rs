//! The nominal model and its comparator, calibrated before any network is trained.
//!
//! | data                              | nominal model is calibrated on                     |
//! | --------------------------------- | -------------------------------------------------- |
//! | with calibration trials           | those, once                                        |
//! | without                           | the training trials of each fold, once per fold    |
//! | own `[[predicted]]` columns, no `[arm]` | nothing: those columns are the prediction    |
//! | with `nominal.augmented`          | nothing: the saved model predicts ([`crate::run::nominal::augmented`]) |
//!
//! Held-out trials are never calibrated on. [`poses`] writes the poses of the calibrated arm along them.

pub mod augmented;
pub mod poses;

use std::collections::BTreeMap;

use acm_core::degree::degree;
use acm_core::observations::Observations;
use acm_core::{ArmSpec, Calibration, NominalModel, NominalSpec, calibrate};
use acm_datasets::{Manifest, Role, Trial};
use nalgebra::DMatrix;

use super::{
    data::Data,
    error::RunError,
    names,
    plan::Plan,
    record::{CalibrationPair, DataStamp, FORMAT, NominalRecord, NominalSource},
};
use crate::config::{Nominal, NominalKind, Source, find_file};

/// The nominal model to calibrate.
#[derive(Debug, Clone)]
pub struct Choice {
    source: NominalSource,
    /// Model to be calibrated; `None` where the prediction comes with the data or a saved model.
    spec: Option<NominalSpec>,
    /// Whether the degree of a polynomial is chosen on the data ([`degree`]).
    chooses_degree: bool,
    /// Arm within a saved model.
    saved_arm: Option<NominalModel>,
    comparator: NominalSpec,
}

impl Choice {
    /// Returns the nominal model to calibrate; `None` where the prediction comes with the data.
    pub fn spec(&self) -> Option<&NominalSpec> {
        self.spec.as_ref()
    }
}

/// Chooses the nominal model: that of the experiment, or else that of the manifest.
///
/// # Errors
/// The experiment asks for a model that the data cannot have.
pub fn choose(nominal: &Nominal, source: &Source, manifest: &Manifest) -> Result<Choice, RunError> {
    let comparator = NominalSpec::Polynomial { degree: nominal.comparator_degree };
    if let Some(named) = &nominal.augmented {
        let saved = find_file(named, source.path()).map(|file| augmented::read(&file)).transpose()?;
        let saved_arm = saved.map(|model| model.nominal().clone()).filter(NominalModel::is_arm);
        return Ok(Choice {
            source: NominalSource::Augmented,
            spec: None,
            chooses_degree: false,
            saved_arm,
            comparator,
        });
    }
    let kind = kind(nominal, manifest);
    let spec = spec(kind, nominal, source, manifest)?;
    let chooses_degree = kind == NominalKind::Polynomial && nominal.degree.is_none();
    Ok(Choice { source: origin(kind, manifest), spec, chooses_degree, saved_arm: None, comparator })
}

/// Computes every calibration that the plans need.
///
/// # Errors
/// A fit is impossible.
pub fn calibrations(choice: &Choice, data: &Data, plans: &[Plan], stamp: DataStamp) -> Result<NominalRecord, RunError> {
    let groups: BTreeMap<String, Vec<String>> =
        plans.iter().map(|plan| (group(&data.manifest, plan), trials_of(data, plan))).collect();
    let pair = |trials: Vec<String>| -> Result<CalibrationPair, RunError> {
        let observed = data.observations(&trials)?;
        let spec = choice.spec.clone().map(|spec| match choice.chooses_degree {
            true => NominalSpec::Polynomial { degree: degree(&observed) },
            false => spec,
        });
        let nominal = spec.map(|spec| fit(&spec, &observed, &trials)).transpose()?;
        let polynomial = fit(&choice.comparator, &observed, &trials)?;
        Ok(CalibrationPair { nominal, saved_arm: choice.saved_arm.clone(), polynomial, trials })
    };
    let calibrations =
        groups.into_iter().map(|(group, trials)| Ok((group, pair(trials)?))).collect::<Result<_, RunError>>()?;
    Ok(NominalRecord { format: FORMAT, data: stamp, source: choice.source, calibrations, runs: vec![] })
}

/// Returns the group of calibrations that a plan uses: `calibration`, or its fold's own, or that of `all` trials.
pub fn group(manifest: &Manifest, plan: &Plan) -> String {
    match () {
        () if manifest.calibrates() => "calibration".into(),
        () if plan.follows_folds() => "all".into(),
        () => format!("fold{}", plan.folds.fold),
    }
}

/// Returns the nominal prediction and comparator of a trial, [T×M] each.
pub fn predict(pair: &CalibrationPair, trial: &Trial) -> (DMatrix<f64>, DMatrix<f64>) {
    let nominal = match (&pair.nominal, &trial.predicted) {
        (Some(fitted), _) => fitted.model.predict(&trial.actuators),
        (None, Some(own)) => own.clone(),
        (None, None) => DMatrix::zeros(trial.measured.nrows(), trial.measured.ncols()),
    };
    (nominal, pair.polynomial.model.predict(&trial.actuators))
}

fn trials_of(data: &Data, plan: &Plan) -> Vec<String> {
    if data.manifest.calibrates() {
        data.of_role(Role::Calibration).map(|entry| entry.name.clone()).collect()
    } else {
        plan.split.training.clone()
    }
}

fn kind(nominal: &Nominal, manifest: &Manifest) -> NominalKind {
    let has_arm = manifest.arm.is_some();
    let own = !manifest.predicted.is_empty();
    nominal.model.unwrap_or(match (has_arm, own) {
        (true, _) => NominalKind::Strain,
        (false, true) => NominalKind::Predicted,
        (false, false) => NominalKind::Polynomial,
    })
}

fn origin(kind: NominalKind, manifest: &Manifest) -> NominalSource {
    match kind {
        NominalKind::Predicted => NominalSource::Predicted,
        NominalKind::None => NominalSource::None,
        _ if manifest.calibrates() => NominalSource::CalibrationTrials,
        _ => NominalSource::TrainingTrials,
    }
}

/// Returns the nominal model to calibrate; `None` where the data include the prediction.
fn spec(
    kind: NominalKind,
    nominal: &Nominal,
    source: &Source,
    manifest: &Manifest,
) -> Result<Option<NominalSpec>, RunError> {
    let refuse = |what: String, help: &str| {
        let key = ["nominal".to_string(), "model".to_string()];
        Err(RunError::from(Box::new(source.complaint(&key, what, help))))
    };
    match (kind, manifest.nominal_spec()) {
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
            format!("`nominal.model` is \"strain\", and the manifest of {} describes no [arm]", manifest.name),
            "describe the arm in the manifest, or write model = \"polynomial\"",
        ),
        (NominalKind::Predicted, _) if manifest.predicted.is_empty() => refuse(
            format!("`nominal.model` is \"predicted\", and the data {} have no [[predicted]] columns", manifest.name),
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

fn fit(spec: &NominalSpec, observed: &Observations, names: &[String]) -> Result<Calibration, RunError> {
    calibrate(spec, observed).map_err(|source| RunError::Calibration { trials: names::some(names, ", "), source })
}
