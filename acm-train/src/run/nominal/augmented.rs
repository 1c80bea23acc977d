//! A saved model with effects as the nominal model of an experiment.
//!
//! Effects remember, so it predicts whole trials, before the domain filter takes samples out of them. Its predictions
//! then take the place of the data's own `[[predicted]]` columns.

mod belongs;

use std::path::Path;

use acm_core::augmented::AugmentedModel;
use acm_datasets::{
    Campaign, Role, Trial,
    rig::{record, rig},
};

pub use belongs::origin;

use crate::run::error::RunError;
use crate::{
    config::{Nominal, Source, find_file},
    store::hashed,
};

/// A campaign with the predictions of a saved model.
#[derive(Debug)]
pub struct Predicted {
    /// Data as read, where no model was named.
    pub campaign: Campaign,
    /// Warnings where the data leave the range that the model was made for.
    pub warnings: Vec<String>,
}

/// Returns the campaign with the predictions of `nominal.augmented` where the experiment names one; its hash is noted.
///
/// # Errors
/// There is no such file, it is not the one that was noted, it is damaged, or it belongs to another rig.
pub fn predicted(campaign: Campaign, nominal: &mut Nominal, source: &Source) -> Result<Predicted, RunError> {
    let Some(named) = nominal.augmented.clone() else { return Ok(Predicted { campaign, warnings: vec![] }) };
    let refuse = |key: &str, what: String, help: &str| {
        Err(RunError::from(Box::new(source.complaint(&["nominal".into(), key.into()], what, help))))
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
    let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded).collect();
    belongs::check(&model, &rig(&campaign, &used), &campaign.manifest, &file)?;
    nominal.augmented_sha256 = Some(hash);
    let trials = campaign.trials.iter().map(|trial| with_prediction(&model, &campaign, trial, &file));
    let campaign = Campaign { trials: trials.collect::<Result<_, _>>()?, ..campaign };
    let told = belongs::left_ranges(&model, &campaign).into_iter().chain(belongs::is_worse(&model, &campaign));
    let warnings = told.map(|told| format!("{}: {told}", file.display())).collect();
    Ok(Predicted { campaign, warnings })
}

/// Returns a saved model, as `acm-eval close-loop` writes it ([`hashed`]).
///
/// # Errors
/// The file cannot be read, has been changed since it was written, or is none.
pub fn read(file: &Path) -> Result<AugmentedModel, RunError> {
    let unusable = |why: String| RunError::Unusable {
        what: format!("{} is no model with effects: {why}", file.display()),
        help: "give the model.json of `acm-eval close-loop` as it was written; run that again if the file is damaged"
            .into(),
    };
    let text = hashed::verify(&hashed::bytes(file)?).map_err(|broken| unusable(broken.to_string()))?;
    serde_json::from_str(&text).map_err(|error| unusable(error.to_string()))
}

fn with_prediction(model: &AugmentedModel, campaign: &Campaign, trial: &Trial, file: &Path) -> Result<Trial, RunError> {
    let (whole, rows) = trial.with_unmeasured();
    let predicted = model.predict(&record(campaign, trial), whole.predicted.as_ref());
    if let Some(value) = predicted.iter().find(|value| !value.is_finite()) {
        return Err(RunError::Unusable {
            what: format!("{} predicts {value} in trial {}", file.display(), trial.name),
            help: "the model was fitted to other motions than these: exclude the trial, or fit it again".into(),
        });
    }
    let mut trial = trial.clone();
    if let Some(lost) = &mut trial.unmeasured {
        let others: Vec<usize> = (0..whole.samples()).filter(|row| rows.binary_search(row).is_err()).collect();
        lost.predicted = Some(predicted.select_rows(&others));
    }
    trial.predicted = Some(predicted.select_rows(&rows));
    Ok(trial)
}
