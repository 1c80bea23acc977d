//! Check that a saved model belongs to the robot of the data.
//!
//! | compared                                             | where it differs |
//! | ---------------------------------------------------- | ---------------- |
//! | names and units of actuators, contexts, outputs      | refused          |
//! | `[arm]`: length, gravity, axis, strain basis         | refused          |
//! | a carrier, `[[predicted]]` columns                   | refused          |
//! | ranges of actuators and contexts                     | warning          |
//! | error on the calibration trials                      | warning          |
//!
//! The data's hash is not: the same robot may have recordings in another folder. A file that an earlier version wrote tells less,
//! and only what it tells is compared.

use std::path::Path;

use acm_core::{
    augmented::{ArmShape, AugmentedModel, ManifestUnits, Origin},
    display::{DIGITS, significant},
    rig::{Mounting, Rig, Signal},
};
use acm_datasets::{Campaign, Manifest, Role, Trial, manifest, rig::record};
use nalgebra::DMatrix;

use crate::run::{error::RunError, names};

/// Relative difference that units and decimals make between two equal lengths or directions.
const ROUNDING: f64 = 1e-6;

/// Tolerance for rounding, as a share of a range.
const SLACK: f64 = 1e-9;

/// Ratio to the error at which the model was made, from which on the data are taken for another robot's.
const WORSE: f64 = 3.0;

/// Share of an output's range below which an error is no reason to warn.
const SMALL: f64 = 0.01;

const REMEDY: &str = "run `acm-eval close-loop` on these data, or use the data that the model was made from";

/// Refuses a model of another rig; `own` is the rig of the data.
pub fn check(model: &AugmentedModel, own: &Rig, manifest: &Manifest, file: &Path) -> Result<(), RunError> {
    let unusable = |what: String, help: &str| {
        let what = format!("{} does not fit the data {}: {what}", file.display(), manifest.name);
        Err(RunError::Unusable { what, help: help.into() })
    };
    let known = model.rig();
    for (what, found, needed) in [
        ("actuators", &own.actuators, &known.actuators),
        ("context signals and conditions", &own.contexts, &known.contexts),
        ("outputs", &own.outputs, &known.outputs),
    ] {
        if listed(found) != listed(needed) {
            return unusable(
                format!("its {what} are {}, those of the data are {}", listed(needed), listed(found)),
                REMEDY,
            );
        }
    }
    if let Some((what, its, theirs)) = other_arm(model, own, manifest) {
        return unusable(format!("its [arm] has {what} {its}, that of the data has {theirs}"), REMEDY);
    }
    if known.carried && manifest.vehicle.is_none() {
        let what = "it uses the carrier's acceleration, and the manifest has no [vehicle]".into();
        return unusable(what, "describe the carrier's position in the manifest");
    }
    if model.needs_prediction() && manifest.predicted.is_empty() {
        let what = "it is based on predictions that come with the data, and these have no [[predicted]] columns".into();
        return unusable(what, "list the columns in the manifest");
    }
    Ok(())
}

/// Returns the difference between the arm of the model and that of the data: its name, and both values.
fn other_arm(model: &AugmentedModel, own: &Rig, manifest: &Manifest) -> Option<(&'static str, String, String)> {
    let (its, theirs) = match (&model.rig().arm, &own.arm) {
        (None, None) => return None,
        (Some(its), Some(theirs)) => (its, theirs),
        (its, theirs) => return Some(("length", length(its.as_ref()), length(theirs.as_ref()))),
    };
    if (its.length - theirs.length).abs() > ROUNDING * its.length.abs().max(theirs.length.abs()) {
        return Some(("length", length(Some(its)), length(Some(theirs))));
    }
    if (its.down - theirs.down).amax() > ROUNDING {
        let shown = |arm: &Mounting| format!("along ({}, {}, {})", arm.down.x, arm.down.y, arm.down.z);
        return Some(("gravity", shown(its), shown(theirs)));
    }
    let (its, theirs) = (model.origin()?.arm?, shape(manifest)?);
    if its.axis != theirs.axis {
        return Some(("axis", written(&its.axis), written(&theirs.axis)));
    }
    (its.strain != theirs.strain).then(|| ("strain", written(&its.strain), written(&theirs.strain)))
}

fn length(arm: Option<&Mounting>) -> String {
    arm.map_or("none".into(), |arm| format!("{} m", arm.length))
}

/// Writes a value in the notation of the manifest.
fn written(value: &impl serde::Serialize) -> String {
    toml::Value::try_from(value).map_or(String::new(), |value| value.to_string())
}

fn shape(manifest: &Manifest) -> Option<ArmShape> {
    let spec = manifest.arm.as_ref()?.spec();
    Some(ArmShape { axis: spec.axis, strain: spec.strain })
}

fn listed(signals: &[Signal]) -> String {
    let named: Vec<String> = signals.iter().map(|signal| format!("{} [{}]", signal.name, signal.unit)).collect();
    if named.is_empty() { "none".into() } else { named.join(", ") }
}

/// Describes where the data leave the calibrated range of the model: signal, number of samples, and distance.
pub fn left_ranges(model: &AugmentedModel, campaign: &Campaign) -> Vec<String> {
    let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded).collect();
    let records: Vec<_> = used.iter().map(|trial| record(campaign, trial)).collect();
    let rig = model.rig();
    let actuators =
        rig.actuators.iter().enumerate().map(|(j, s)| (s, records.iter().map(|r| &r.actuators[j]).collect()));
    let contexts = rig.contexts.iter().enumerate().map(|(j, s)| (s, records.iter().map(|r| &r.contexts[j]).collect()));
    actuators.chain(contexts).filter_map(|(signal, columns)| left_range(signal, columns)).collect()
}

fn left_range(signal: &Signal, columns: Vec<&Vec<f64>>) -> Option<String> {
    let slack = SLACK * signal.span().max(signal.magnitude());
    let beyond = |value: f64| (signal.low - value).max(value - signal.high);
    let values: Vec<f64> = columns.into_iter().flatten().copied().collect();
    let outside: Vec<f64> = values.iter().copied().filter(|value| beyond(*value) > slack).collect();
    let furthest = outside.iter().copied().max_by(|a, b| beyond(*a).total_cmp(&beyond(*b)))?;
    let share = 100.0 * outside.len() as f64 / values.len() as f64;
    let [low, high, furthest, by] =
        [signal.low, signal.high, furthest, beyond(furthest)].map(|value| significant(value, DIGITS));
    let (name, unit) = (&signal.name, &signal.unit);
    Some(format!(
        "{name} leaves the range that it was calibrated on, {low} to {high} {unit}, in {} % of the samples, by up to {by} {unit} \
         (at {furthest} {unit}): there it extrapolates",
        significant(share, DIGITS)
    ))
}

/// Returns the origin of the data that a model was fitted to, with its error there.
pub fn origin(model: &AugmentedModel, campaign: &Campaign) -> Origin {
    let trials = compared(campaign);
    let predicted = |trial: &&Trial| {
        let (whole, rows) = trial.with_unmeasured();
        model.predict(&record(campaign, trial), whole.predicted.as_ref()).select_rows(&rows)
    };
    Origin {
        data: campaign.manifest.name.clone(),
        arm: shape(&campaign.manifest),
        trials: trials.iter().map(|trial| trial.name.clone()).collect(),
        rms: rms(trials.iter().map(|trial| (&trial.measured, predicted(trial)))),
        units: Some(units(model, &campaign.manifest)),
    }
}

/// Returns the units of the manifest for the signals of the model.
fn units(model: &AugmentedModel, manifest: &Manifest) -> ManifestUnits {
    let listed = |signals: &[manifest::Signal]| signals.iter().map(|signal| signal.unit.clone()).collect();
    let context = |signal: &Signal| {
        let own = manifest.context.iter().find(|context| context.name() == signal.name);
        let condition = || manifest.conditions.values().find_map(|constants| constants.get(&signal.name));
        let unit = own.map(|own| own.unit.clone()).or_else(|| condition().map(|quantity| quantity.unit.clone()));
        unit.unwrap_or_else(|| signal.unit.clone())
    };
    ManifestUnits {
        actuators: listed(&manifest.actuator),
        contexts: model.rig().contexts.iter().map(context).collect(),
        outputs: manifest.measured.iter().map(|measured| measured.unit.clone()).collect(),
    }
}

/// Warns where the model, whose predictions the campaign has, is much worse on it than where it was made.
pub fn is_worse(model: &AugmentedModel, campaign: &Campaign) -> Option<String> {
    let origin = model.origin()?;
    let trials = compared(campaign);
    let pairs = trials.iter().filter_map(|trial| Some((&trial.measured, trial.predicted.clone()?)));
    let (outputs, found) = (&model.rig().outputs, rms(pairs));
    let worse = |(output, (found, stated)): (&Signal, (&f64, &f64))| {
        let least = WORSE * stated.max(SMALL * output.span());
        (*found > least).then(|| {
            let (found, stated) = (significant(*found, DIGITS), significant(*stated, DIGITS));
            format!("{} by {found} {unit} RMS, where it was made by {stated} {unit}", output.name, unit = output.unit)
        })
    };
    let said: Vec<String> = outputs.iter().zip(found.iter().zip(&origin.rms)).filter_map(worse).collect();
    (!said.is_empty()).then(|| {
        let trials: Vec<&str> = trials.iter().map(|trial| trial.name.as_str()).collect();
        format!(
            "on {} it misses {}: it may be of another robot than these data; if so, run `acm-eval close-loop` on them",
            names::some(&trials, ", "),
            said.join("; ")
        )
    })
}

/// Returns the trials that distinguish robots best: those that calibrate, else those of the development.
fn compared(campaign: &Campaign) -> Vec<&Trial> {
    let calibration: Vec<&Trial> = campaign.trials(Role::Calibration).collect();
    if calibration.is_empty() { campaign.trials(Role::Development).collect() } else { calibration }
}

/// Returns the root mean square of measured − predicted, over all samples of all trials.
fn rms<'a>(pairs: impl Iterator<Item = (&'a DMatrix<f64>, DMatrix<f64>)>) -> Vec<f64> {
    let (mut squares, mut samples) = (vec![], 0);
    for (measured, predicted) in pairs {
        squares.resize(measured.ncols(), 0.0);
        for (o, square) in squares.iter_mut().enumerate() {
            *square += (measured.column(o) - predicted.column(o)).norm_squared();
        }
        samples += measured.nrows();
    }
    squares.into_iter().map(|square| (square / samples.max(1) as f64).sqrt()).collect()
}
