//! A saved model with effects as the nominal model of an experiment.
//!
//! Effects remember, so it predicts whole trials, before the domain filter takes samples out of them. Its predictions
//! then take the place of the data's own `[[predicted]]` columns.

use std::path::Path;

use acm_core::{augmented::AugmentedModel, rig::Signal};
use acm_datasets::{
    Campaign, Role, Trial,
    rig::{record, rig},
};

use crate::{
    error::TrainError,
    experiment::{Nominal, Source, find_file},
    hashed,
};

/// The campaign with the predictions of `nominal.augmented` where the experiment names one; its hash is noted.
///
/// # Errors
/// There is no such file, it is not the one that was noted, it is damaged, or it belongs to another rig.
pub fn predicted(campaign: Campaign, nominal: &mut Nominal, source: &Source) -> Result<Campaign, TrainError> {
    let Some(named) = nominal.augmented.clone() else { return Ok(campaign) };
    let refuse = |key: &str, what: String, help: &str| {
        Err(TrainError::from(Box::new(source.complaint(&["nominal".into(), key.into()], what, help))))
    };
    let Some(file) = find_file(&named, source.path()) else {
        let help =
            "name the model.json that `acm-eval close-loop` wrote, as seen from here or from the experiment file";
        return refuse("augmented", format!("`nominal.augmented` is {named:?}, and there is no such file"), help);
    };
    let hash = hashed::of_file(&file)?;
    if let Some(noted) = nominal.augmented_sha256.as_ref().filter(|noted| **noted != hash) {
        let what = format!("`nominal.augmented_sha256` is {noted}, and {} has {hash}", file.display());
        return refuse("augmented_sha256", what, "bring the former file back, or delete the hash to run with this one");
    }
    let model = read(&file)?;
    belongs(&model, &campaign, &file)?;
    nominal.augmented_sha256 = Some(hash);
    let trials = campaign.trials.iter().map(|trial| with_prediction(&model, &campaign, trial, &file));
    Ok(Campaign { trials: trials.collect::<Result<_, _>>()?, ..campaign })
}

/// A saved model, as `acm-eval close-loop` writes it ([`hashed`]).
///
/// # Errors
/// The file cannot be read, has been changed since it was written, or is none.
pub fn read(file: &Path) -> Result<AugmentedModel, TrainError> {
    let unusable = |why: String| TrainError::Unusable {
        what: format!("{} is no model with effects: {why}", file.display()),
        help: "give the model.json of `acm-eval close-loop` as it was written; run that again if the file is damaged"
            .into(),
    };
    let text = hashed::verify(&hashed::bytes(file)?).map_err(|broken| unusable(broken.to_string()))?;
    serde_json::from_str(&text).map_err(|error| unusable(error.to_string()))
}

/// Signals are known to a model by their place, so names and order must agree.
fn belongs(model: &AugmentedModel, campaign: &Campaign, file: &Path) -> Result<(), TrainError> {
    let unusable = |what: String, help: &str| {
        let what = format!("{} does not fit the data {}: {what}", file.display(), campaign.manifest.name);
        Err(TrainError::Unusable { what, help: help.into() })
    };
    let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded).collect();
    let (own, known) = (rig(campaign, &used), model.rig());
    for (what, found, needed) in [
        ("actuators", &own.actuators, &known.actuators),
        ("context signals and conditions", &own.contexts, &known.contexts),
        ("outputs", &own.outputs, &known.outputs),
    ] {
        if listed(found) != listed(needed) {
            let what = format!("its {what} are {}, those of the data are {}", listed(needed), listed(found));
            return unusable(
                what,
                "run `acm-eval close-loop` on these data, or use the data that the model was made from",
            );
        }
    }
    if known.carried && campaign.manifest.vehicle.is_none() {
        return unusable(
            "it knows a carrier that accelerates, and the manifest has no [vehicle]".into(),
            "describe the carrier's position in the manifest",
        );
    }
    if model.needs_prediction() && campaign.manifest.predicted.is_empty() {
        return unusable(
            "it stands on predictions that come with the data, and these have no [[predicted]] columns".into(),
            "list the columns in the manifest",
        );
    }
    Ok(())
}

fn listed(signals: &[Signal]) -> String {
    let named: Vec<String> = signals.iter().map(|signal| format!("{} [{}]", signal.name, signal.unit)).collect();
    if named.is_empty() { "none".into() } else { named.join(", ") }
}

fn with_prediction(
    model: &AugmentedModel,
    campaign: &Campaign,
    trial: &Trial,
    file: &Path,
) -> Result<Trial, TrainError> {
    let predicted = model.predict(&record(campaign, trial), trial.predicted.as_ref());
    if let Some(value) = predicted.iter().find(|value| !value.is_finite()) {
        return Err(TrainError::Unusable {
            what: format!("{} predicts {value} in trial {}", file.display(), trial.name),
            help: "the model was fitted to other motions than these: exclude the trial, or fit it again".into(),
        });
    }
    Ok(Trial { predicted: Some(predicted), ..trial.clone() })
}
