//! From a run folder to the parts of an estimator.
//!
//! | part              | comes from                                                             |
//! | ----------------- | ---------------------------------------------------------------------- |
//! | network           | the checkpoint's best epoch                                            |
//! | scalers, ranges   | the training part, computed again from the data                        |
//! | nominal model     | `nominal.json`, or the model with effects that the experiment names    |
//! | interval          | `intervals.json`                                                       |
//! | first elapsed time | the median step of the training part; with a carried state, `windows.max_gap` |
//!
//! The checkpoint holds a hash over the windows that it was trained on, after scaling: data that have changed since are
//! found out.

use std::path::{Path, PathBuf};

use crate::closed_loop::folder;
use crate::error::EvalError;
use acm_core::{NominalModel, augmented::AugmentedModel};
use acm_datasets::{Domain, Manifest, Role, rig};
use acm_stream::{ChannelRange, Interval, Nominal, Parts, Scaler, Shape, Signals, StateRule};
use acm_train::config::{self, Elapsed, Experiment, Source};
use acm_train::learn::straight::Straight;
use acm_train::run::evaluation::intervals;
use acm_train::run::evaluation::verdict::{self, Answer};
use acm_train::run::nominal::{augmented, group};
use acm_train::run::progress::Progress;
use acm_train::run::record::{CalibrationPair, NominalSource, RunRecord, Stage, read_nominal, read_records};
use acm_train::run::stop::Stop;
use acm_train::run::trained::Trained;
use acm_train::schedule::ready::{Campaigns, Ready};
use acm_train::schedule::request::Request as Job;

use super::wiring::Wiring;

/// Selection of a run's network.
pub struct Request<'a> {
    /// The run folder.
    pub run: &'a Path,
    /// Name of the network's run; the final run with the smallest validation loss where it is left out.
    pub id: Option<&'a str>,
    /// Folder of the data set's tables, where they do not lie beside its manifest.
    pub data: Option<&'a Path>,
    /// Whether the network processes windows, as it was scored, or keeps its state.
    pub windows: bool,
}

/// A network with all that it needs beside a robot.
pub struct Saved {
    /// Parts of the estimator.
    pub parts: Parts,
    /// Columns of the signals.
    pub wiring: Wiring,
    /// Domain that the network was trained in; samples outside are not processed by it.
    pub domain: Domain,
    /// Name of the network's run.
    pub id: String,
    /// One line about the data, for people.
    pub title: String,
    /// Warning that the nominal model alone is as good, where the folds say so.
    pub doubt: Option<String>,
}

/// Reads a run, and its data for the scalers.
///
/// # Errors
/// What is no run, has no such network, or was trained on other data than those that are there.
pub fn load(request: &Request) -> Result<Saved, EvalError> {
    let file = request.run.join("experiment.toml");
    if request.run.is_file() {
        let path = request.run.display();
        return Err(EvalError::Usage(format!(
            "{path} is a file; give a run folder, such as runs/cfc; files are for `acm-eval export {path} --c99 DIR`"
        )));
    }
    if !request.run.is_dir() {
        return Err(EvalError::NoFolder { path: request.run.into() });
    }
    refuse_loop(request.run)?;
    if !file.is_file() || !request.run.join("records").is_dir() {
        return Err(EvalError::NotARun { path: request.run.into(), missing: "experiment.toml or no records/" });
    }
    let (experiment, source) = config::read(&file, &[])?;
    if experiment.baseline.is_some() {
        let what = format!("{} holds a {}, no network", request.run.display(), experiment.kind());
        return Err(EvalError::Usage(format!("{what}; give a run folder without [baseline]")));
    }
    refuse_blindfolds(&experiment, request.run)?;
    let records = read_records(request.run)?;
    let doubt = doubt(&records);
    let record = chosen(records, request.run, request.id)?;
    // The record carries its hash, the file for people does not.
    if experiment != record.experiment {
        let what = format!("{} is not what {} was run with", file.display(), record.id);
        return Err(EvalError::Data(format!("{what}; bring the former file back")));
    }
    let opened = Opened::new(experiment, &source, request)?;
    let Opened { ready, model, domain } = &opened;
    let plan = ready.plans.iter().find(|plan| plan.id == record.id).ok_or_else(|| {
        let what = format!("{}: {} is not planned any more", request.run.display(), record.id);
        EvalError::Data(format!("{what}; the program has changed since: train again with another --out"))
    })?;
    let (setting, manifest) = (ready.setting(), &ready.data.manifest);
    let pair = ready.nominal.calibrations.get(&group(manifest, plan)).ok_or_else(|| {
        let what = format!("{}: nominal.json has no calibration for {}", request.run.display(), record.id);
        EvalError::Data(format!("{what}; the file is damaged: train again with another --out"))
    })?;
    let Trained { scalers, ranges, mut weights } =
        Trained::read(&setting, plan, record.members.len().max(1), request.run)?;
    let nominal = predicts(ready.nominal.source, pair, model.clone(), manifest);
    let wiring = Wiring::new(manifest, setting.channels, &nominal)?;
    let asked = &setting.experiment.windows;
    let scaler = |s: acm_datasets::Standardizer| Scaler { mean: s.mean, spread: s.spread };
    let parts = Parts {
        signals: Signals { actuators: wiring.actuators(), contexts: wiring.contexts() },
        nominal,
        tip: manifest.tip_columns(),
        channels: wiring.channels.clone(),
        ranges: Some(ranges.into_iter().map(|(low, high)| ChannelRange { low, high }).collect()),
        network: Shape {
            body: setting.experiment.network.architecture().body(),
            inputs: scalers.inputs.mean.len(),
            outputs: scalers.targets.mean.len() + scalers.actuators.len(),
        },
        inputs: scaler(scalers.inputs),
        targets: scaler(scalers.targets),
        weights: weights.remove(0),
        members: weights,
        actuators: scalers.actuators,
        straight: scalers.straight.as_ref().map_or(vec![], Straight::rows),
        interval: interval(request.run)?,
        labels: Some(wiring.labels()),
        factor: record.factor,
        max_gap: asked.gap(),
        first_elapsed: match setting.experiment.memory.is_trial() {
            true => asked.gap(),
            false => opened.step(&plan.split.training)?,
        },
        state: if request.windows { StateRule::Window(asked.length) } else { StateRule::Running },
    };
    let title = manifest.title.clone();
    Ok(Saved { parts, wiring, domain: domain.clone(), id: record.id, title, doubt })
}

/// Returns the nominal model of a run folder without its network, once for each calibration.
///
/// # Errors
/// As [`load`].
pub fn alone(request: &Request) -> Result<Vec<Saved>, EvalError> {
    let (experiment, source) = config::read(&request.run.join("experiment.toml"), &[])?;
    let records = read_records(request.run)?;
    let record = records.first().ok_or_else(|| EvalError::NoRecords { path: request.run.into() })?;
    let opened = Opened::new(experiment, &source, request)?;
    let Opened { ready: Ready { data, nominal: calibrations, .. }, model, domain } = &opened;
    let manifest = &data.manifest;
    let used: Vec<String> =
        (data.entries.iter().filter(|entry| entry.role != Role::Excluded)).map(|entry| entry.name.clone()).collect();
    let step = opened.step(&used)?;
    let one = |pair: &CalibrationPair| {
        let nominal = predicts(calibrations.source, pair, model.clone(), manifest);
        let wiring = Wiring::new(manifest, &[], &nominal)?;
        let signals = Signals { actuators: wiring.actuators(), contexts: wiring.contexts() };
        let mut parts = Parts::alone(signals, nominal, manifest.tip_columns(), step)
            .map_err(|error| EvalError::Data(format!("{}: {error}", request.run.display())))?;
        parts.labels = Some(wiring.labels());
        let (domain, title) = (domain.clone(), manifest.title.clone());
        Ok(Saved { parts, wiring, domain, id: record.id.clone(), title, doubt: None })
    };
    calibrations.calibrations.values().map(one).collect()
}

/// A run folder with the data of its runs, prepared as they were.
struct Opened {
    ready: Ready,
    /// Model with effects that predicts, where the experiment names one.
    model: Option<AugmentedModel>,
    domain: Domain,
}

impl Opened {
    fn new(experiment: Experiment, source: &Source, request: &Request) -> Result<Self, EvalError> {
        let (progress, stop) = (Progress::Quiet, Stop::default());
        let job = Job { data: request.data, ..Job::new(request.run, &progress, &stop) };
        let nominal = read_nominal(request.run)?;
        let ready = Ready::calibrated(experiment, source, &job, &mut Campaigns::default(), nominal)?;
        let named = ready.experiment.nominal.augmented.as_ref();
        let model = named.map(|named| model(named, source)).transpose()?;
        let calibration: Vec<String> = ready.data.of_role(Role::Calibration).map(|entry| entry.name.clone()).collect();
        let filter = ready.experiment.inputs.domain_filter;
        let domain = Domain::fit_stream(filter, || ready.data.trials(&calibration)).map_err(EvalError::Table)?;
        Ok(Self { ready, model, domain })
    }

    /// Returns the median time between samples of some trials, s.
    fn step(&self, trials: &[String]) -> Result<f64, EvalError> {
        let trials: Vec<_> = self.ready.data.trials(trials).collect::<Result<_, _>>().map_err(EvalError::Table)?;
        Ok(rig::step(&trials.iter().map(|trial| &**trial).collect::<Vec<_>>()))
    }
}

/// Refuses the folder of a closed loop, which holds a model and no network.
fn refuse_loop(run: &Path) -> Result<(), EvalError> {
    if run.join("experiment.toml").is_file() || !run.join(folder::FINDING).is_file() {
        return Ok(());
    }
    let path = run.display();
    Err(EvalError::Usage(format!(
        "{path} is the result of a closed loop: a model without a network; `acm-eval export {path} --c99 DIR` writes it as C, \
         networks on top of it, if any were trained, are in {path}/networks, and acm-train trains one by nominal.augmented = \
         \"{path}/model.json\""
    )))
}

/// Refuses a network that was trained without an input, for a comparison.
fn refuse_blindfolds(experiment: &Experiment, run: &Path) -> Result<(), EvalError> {
    let what = match (&experiment.inputs.shuffled, experiment.windows.elapsed) {
        (shuffled, _) if !shuffled.is_empty() => format!("inputs.shuffled = {shuffled:?}"),
        (_, Elapsed::One) => "windows.elapsed = \"one\"".into(),
        (_, Elapsed::Measured) => return Ok(()),
    };
    let what = format!("{}: the network was trained with {what}, to see what that costs", run.display());
    Err(EvalError::Data(format!("{what}; train one without it for use")))
}

/// Returns the interval that the trials left out give the predictions of a run or a study; older ones have none.
pub(super) fn interval(run: &Path) -> Result<Option<Interval>, EvalError> {
    let Some(found) = intervals::read(run)? else { return Ok(None) };
    let half_widths = found.outputs.iter().map(|of| of.half_width).collect();
    Ok(Some(Interval { level: found.level, half_widths }))
}

/// Returns the verdict of the folds, where it is that no network is worth it.
fn doubt(records: &[RunRecord]) -> Option<String> {
    let records: Vec<&RunRecord> = records.iter().collect();
    let verdict = verdict::of(&records).filter(|verdict| verdict.answer == Answer::NotWorthIt)?;
    Some(verdict.sentence(&records))
}

/// Returns the record of the network called `id`; without it, the final one with the smallest validation loss.
///
/// # Errors
/// There is no such network, or none at all.
pub fn chosen(records: Vec<RunRecord>, run: &Path, id: Option<&str>) -> Result<RunRecord, EvalError> {
    let ids: Vec<String> = records.iter().map(|record| record.id.clone()).collect();
    let loss = |record: &RunRecord| {
        let epoch = record.epoch_zero.iter().chain(&record.epochs).find(|epoch| epoch.epoch == record.best_epoch);
        epoch.map_or(f64::INFINITY, |epoch| epoch.validation_loss)
    };
    let found = match id {
        Some(id) => records.into_iter().find(|record| record.id == id),
        // Folds are another question: their losses are not those of one part.
        None => records.into_iter().min_by(|a, b| {
            (a.stage != Stage::Final, loss(a))
                .partial_cmp(&(b.stage != Stage::Final, loss(b)))
                .unwrap_or_else(|| a.id.cmp(&b.id))
        }),
    };
    found.ok_or_else(|| match id {
        Some(id) => EvalError::Usage(format!("{} has no network {id:?}; it has {}", run.display(), ids.join(", "))),
        None => EvalError::NoRecords { path: run.into() },
    })
}

/// Returns the saved model, which has been checked against its hash and the data by now.
fn model(named: &Path, source: &Source) -> Result<AugmentedModel, EvalError> {
    let file: PathBuf = config::find_file(named, source.path()).unwrap_or_else(|| named.into());
    Ok(augmented::read(&file)?)
}

fn predicts(
    source: NominalSource,
    pair: &CalibrationPair,
    model: Option<AugmentedModel>,
    manifest: &Manifest,
) -> Nominal {
    let outputs = manifest.measured.len();
    match (model, &pair.nominal, source) {
        (Some(model), ..) => Nominal::Augmented(model),
        (None, Some(calibration), _) => Nominal::Model(calibration.model.clone()),
        (None, None, NominalSource::Predicted) => Nominal::Given(outputs),
        (None, None, _) => Nominal::Model(NominalModel::None { outputs }),
    }
}
