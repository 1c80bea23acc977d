//! What an export is made of: a run, the winner of a study, a closed loop, or a file.

use std::path::{Path, PathBuf};

use acm_core::augmented::{AugmentedModel, ManifestUnits};
use acm_core::rig::Signal;
use acm_datasets::units::Unit;
use acm_eval::closed_loop::folder::{FINDING, MODEL, REFUTED};
use acm_eval::error::EvalError;
use acm_eval::stream::best::{self, SavedBest};
use acm_eval::stream::saved::{Request, load};
use acm_eval::stream::wiring::manifest_unit;
use acm_stream::{AverageParts, Label, Labels, Nominal, Parts, Signals};
use acm_train::store::hashed;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Step of a model that knows none, s.
const STEP: f64 = 0.01;

/// Files that can be exported, for messages.
const FILES: &str =
    "give a run folder, a file of `acm-eval stream RUN --save FILE`, or the model.json of `acm-eval close-loop`";

/// An estimator to export, as an average: of one, or of several.
pub struct Given {
    pub average: AverageParts,
    /// Description of the origin in one line.
    pub source: String,
    /// Run folder and name of each network of a winner.
    pub networks: Vec<(PathBuf, String)>,
}

impl Given {
    /// Reads a run folder, the folder of a study or of a closed loop, or a file.
    ///
    /// # Errors
    /// What holds no estimator.
    pub fn read(request: &Request) -> Result<Self, EvalError> {
        let run = request.run;
        if best::is_one(run) {
            let SavedBest { parts: average, id, title, networks, .. } = best::load(request)?;
            return Ok(Self { average, source: format!("{id} of {}: {title}", run.display()), networks });
        }
        let file = if run.is_file() { Some(run.to_path_buf()) } else { model_of_loop(run)? };
        if let Some(file) = file {
            return Self::of_file(&file, request.id);
        }
        let saved = load(request)?;
        let source = format!("{} of {}: {}", saved.id, run.display(), saved.title);
        Ok(Self { average: AverageParts::of_one(saved.parts), source, networks: vec![] })
    }

    fn of_file(file: &Path, id: Option<&str>) -> Result<Self, EvalError> {
        let path = file.display();
        if let Some(id) = id {
            let what = format!("--network {id} names a network of a run folder, and {path} is a file");
            return Err(EvalError::Usage(format!("{what}; leave --network out")));
        }
        let refuse = |what: String| EvalError::Data(format!("{path}: {what}; {FILES}"));
        let text = hashed::verify(&hashed::bytes(file)?).map_err(|broken| refuse(broken.to_string()))?;
        let value: Value = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
        let has = |key: &str| value.get(key).is_some();
        let average = match (has("weights"), has("members"), has("rig")) {
            (true, ..) => AverageParts::of_one(read(&text).map_err(refuse)?),
            (false, true, _) => read(&text).map_err(refuse)?,
            (false, false, true) => of_model(read(&text).map_err(refuse)?).map_err(refuse)?,
            (false, false, false) => return Err(refuse("it holds neither an estimator nor a model".into())),
        };
        Ok(Self { average, source: path.to_string(), networks: vec![] })
    }
}

fn read<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

/// Returns the file of a closed loop's model; none where the folder is of something else.
fn model_of_loop(folder: &Path) -> Result<Option<PathBuf>, EvalError> {
    let there = |name: &str| folder.join(name).is_file();
    if there("experiment.toml") || ![FINDING, MODEL, REFUTED].into_iter().any(there) {
        return Ok(None);
    }
    if there(MODEL) {
        return Ok(Some(folder.join(MODEL)));
    }
    let file = folder.join(REFUTED);
    let what = match file.is_file() {
        true => format!("held-out trials refute the model; give {} itself to export it all the same", file.display()),
        false => format!("the loop has no {MODEL}; run `acm-eval close-loop` again"),
    };
    Err(EvalError::Usage(format!("{}: {what}", folder.display())))
}

/// Returns a model without a network, with all of its outputs.
fn of_model(model: AugmentedModel) -> Result<AverageParts, String> {
    let rig = model.rig();
    let names = |signals: &[Signal]| signals.iter().map(|signal| signal.name.clone()).collect();
    let signals = Signals { actuators: names(&rig.actuators), contexts: names(&rig.contexts) };
    let (outputs, step) = (rig.outputs.len(), if rig.step > 0.0 { rig.step } else { STEP });
    let units = model.origin().and_then(|origin| origin.units.clone());
    let parts =
        Parts::alone(signals, Nominal::Augmented(model), 0..outputs, step).map_err(|error| error.to_string())?;
    let labels = units.map(|units| with_units(parts.labelled(), units));
    Ok(AverageParts::of_one(Parts { labels, ..parts }))
}

/// Adds the units of the manifest to labels: of actuators and contexts, which come first, and of outputs.
fn with_units(labels: Labels, units: ManifestUnits) -> Labels {
    let known = |label: Label, unit: Option<&String>| {
        let unit = unit.and_then(|name| Unit::parse(name).ok());
        Label { manifest: unit.and_then(|unit| manifest_unit(&unit)), ..label }
    };
    let all = |labels: Vec<Label>, units: Vec<String>| {
        labels.into_iter().enumerate().map(|(k, label)| known(label, units.get(k))).collect()
    };
    let inputs = units.actuators.into_iter().chain(units.contexts).collect();
    Labels { inputs: all(labels.inputs, inputs), outputs: all(labels.outputs, units.outputs) }
}
