//! From a run folder to the parts of an estimator.
//!
//! | part              | comes from                                                             |
//! | ----------------- | ---------------------------------------------------------------------- |
//! | network           | the checkpoint's best epoch                                            |
//! | scalers, ranges   | the training part, computed again from the data                        |
//! | nominal model     | `nominal.json`, or the model with effects that the experiment names    |
//! | interval          | `intervals.json`                                                       |
//! | first elapsed time | the median step of the training part                                  |
//!
//! The checkpoint holds a hash over the windows that it was trained on, after scaling: data that have changed since are
//! found out.

use std::path::{Path, PathBuf};

use crate::closed_loop::folder;
use crate::error::EvalError;
use acm_core::{NominalModel, augmented::AugmentedModel};
use acm_datasets::{Campaign, Domain, Role, Trial, WindowSpec, rig::rig, windows};
use acm_models::{Keep, Network};
use acm_stream::{ChannelRange, Interval, Nominal, Parts, Scaler, Shape, Signals, StateRule};
use acm_train::config::{self, ConfigError, Elapsed, Experiment, Source, Target, device};
use acm_train::learn::checkpoint::{self, Identity};
use acm_train::learn::{Scalers, Task, WindowSet, ensemble};
use acm_train::run::data::prepare::{Part, channels, filtered};
use acm_train::run::evaluation::intervals;
use acm_train::run::evaluation::verdict::{self, Answer};
use acm_train::run::nominal::{augmented, group};
use acm_train::run::plan::Plan;
use acm_train::run::record::{CalibrationPair, FoldStamp, NominalSource, RunRecord, Stage, read_nominal, read_records};

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
    let (mut experiment, source) = config::read(&file, &[])?;
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
    let (campaign, model, domain) = data(&mut experiment, &source, &record, request)?;
    let channels = channels(&mut experiment, &source, &campaign.manifest, &campaign.entries(f64::INFINITY))?;
    let nominal = read_nominal(request.run)?;
    let plan = plan(&record, &experiment);
    let pair = nominal.calibrations.get(&group(&campaign.manifest, &plan)).ok_or_else(|| {
        let what = format!("{}: nominal.json has no calibration for {}", request.run.display(), record.id);
        EvalError::Data(format!("{what}; the file is damaged: train again with another --out"))
    })?;
    let part = |names: &[String]| Part::new(names, &campaign, pair, &channels, &experiment);
    let (training, validation) = (part(&plan.split.training), part(&plan.split.validation));
    let scalers = Scalers::of(&training.series);
    let mut weights = weights(&experiment, &record, request, [&training, &validation], &scalers)?;
    let nominal = predicts(nominal.source, pair, model, &campaign);
    let wiring = Wiring::new(&campaign.manifest, &channels, &nominal)?;
    let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| plan.split.training.contains(&trial.name)).collect();
    let asked = &experiment.windows;
    let interval = interval(request.run)?;
    let scaler = |s: acm_datasets::Standardizer| Scaler { mean: s.mean, spread: s.spread };
    let parts = Parts {
        signals: Signals { actuators: wiring.actuators(), contexts: wiring.contexts() },
        nominal,
        tip: campaign.tip_columns(),
        channels: wiring.channels.clone(),
        ranges: ranges(&training, channels.len()),
        network: Shape {
            body: experiment.network.architecture().body(),
            inputs: scalers.inputs.mean.len(),
            outputs: scalers.targets.mean.len() + scalers.actuators.len(),
        },
        inputs: scaler(scalers.inputs),
        targets: scaler(scalers.targets),
        weights: weights.remove(0),
        members: weights,
        actuators: scalers.actuators.clone(),
        interval,
        labels: Some(wiring.labels()),
        factor: record.factor,
        max_gap: asked.gap(),
        first_elapsed: rig(&campaign, &used).step,
        state: if request.windows { StateRule::Window(asked.length) } else { StateRule::Running },
    };
    Ok(Saved { parts, wiring, domain, id: record.id, title: campaign.manifest.title, doubt })
}

/// Returns the nominal model of a run folder without its network, once for each calibration.
///
/// # Errors
/// As [`load`].
pub fn alone(request: &Request) -> Result<Vec<Saved>, EvalError> {
    let (mut experiment, source) = config::read(&request.run.join("experiment.toml"), &[])?;
    let records = read_records(request.run)?;
    let record = records.first().ok_or_else(|| EvalError::NoRecords { path: request.run.into() })?;
    let (campaign, model, domain) = data(&mut experiment, &source, record, request)?;
    let calibrations = read_nominal(request.run)?;
    let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded).collect();
    let one = |pair: &CalibrationPair| {
        let nominal = predicts(calibrations.source, pair, model.clone(), &campaign);
        let wiring = Wiring::new(&campaign.manifest, &[], &nominal)?;
        let signals = Signals { actuators: wiring.actuators(), contexts: wiring.contexts() };
        let mut parts = Parts::alone(signals, nominal, campaign.tip_columns(), rig(&campaign, &used).step)
            .map_err(|error| EvalError::Data(format!("{}: {error}", request.run.display())))?;
        parts.labels = Some(wiring.labels());
        let (domain, title) = (domain.clone(), campaign.manifest.title.clone());
        Ok(Saved { parts, wiring, domain, id: record.id.clone(), title, doubt: None })
    };
    calibrations.calibrations.values().map(one).collect()
}

/// Returns the smallest and largest value of each channel in the training part.
fn ranges(training: &Part, channels: usize) -> Option<Vec<ChannelRange>> {
    let of = |c: usize| {
        let samples =
            training.series.iter().flat_map(|series| (0..series.time.len()).map(move |t| series.inputs[(t, c)]));
        ChannelRange::of(samples)
    };
    (0..channels).map(of).collect()
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

/// Returns the data that the network was trained on, the model with effects that predicted them, and the domain of
/// their filter.
fn data(
    experiment: &mut Experiment,
    source: &Source,
    record: &RunRecord,
    request: &Request,
) -> Result<(Campaign, Option<AugmentedModel>, Domain), EvalError> {
    let folder = config::find_folder(&experiment.data, source.path()).ok_or_else(|| {
        let what = format!("{}: the data of this run were in {:?}", request.run.display(), experiment.data);
        EvalError::Data(format!("{what}, and there is no such folder here; start where acm-train was started"))
    })?;
    let campaign = Campaign::read(&folder, request.data).map_err(EvalError::Table)?;
    if campaign.hash != record.data.hash {
        return Err(EvalError::Data(format!(
            "{}: these are not the data that {} was trained on (hash {}, then {}); bring the former back, or train again",
            folder.display(),
            request.run.display(),
            short(&campaign.hash),
            short(&record.data.hash)
        )));
    }
    let campaign = augmented::predicted(campaign, &mut experiment.nominal, source)?.campaign;
    let model = experiment.nominal.augmented.as_ref().map(|named| model(named, source)).transpose()?;
    let calibration: Vec<&Trial> = campaign.trials(Role::Calibration).collect();
    let domain = Domain::fit(experiment.inputs.domain_filter, &calibration).map_err(EvalError::Table)?;
    Ok((filtered(campaign, experiment)?, model, domain))
}

fn short(hash: &str) -> String {
    hash.chars().take(12).collect()
}

/// Returns the saved model, which has been checked against its hash and the data by now.
fn model(named: &Path, source: &Source) -> Result<AugmentedModel, EvalError> {
    let file: PathBuf = config::find_file(named, source.path()).unwrap_or_else(|| named.into());
    Ok(augmented::read(&file)?)
}

fn plan(record: &RunRecord, experiment: &Experiment) -> Plan {
    let before = || FoldStamp {
        made: String::new(),
        count: 0,
        value_of: None,
        fold: match record.stage {
            Stage::CrossValidation { fold } => fold,
            Stage::Final => experiment.protocol.validation_fold.unwrap_or(0),
        },
    };
    let (id, folds) = (record.id.clone(), record.folds.clone().unwrap_or_else(before));
    Plan { id, stage: record.stage, seed: record.seed, folds, split: record.split.clone() }
}

fn predicts(
    source: NominalSource,
    pair: &CalibrationPair,
    model: Option<AugmentedModel>,
    campaign: &Campaign,
) -> Nominal {
    let outputs = campaign.manifest.measured.len();
    match (model, &pair.nominal, source) {
        (Some(model), ..) => Nominal::Augmented(model),
        (None, Some(calibration), _) => Nominal::Model(calibration.model.clone()),
        (None, None, NominalSource::Predicted) => Nominal::Given(outputs),
        (None, None, _) => Nominal::Model(NominalModel::None { outputs }),
    }
}

/// Returns the weights of the best epoch of each network, if the checkpoint is of this experiment on these windows.
fn weights(
    experiment: &Experiment,
    record: &RunRecord,
    request: &Request,
    [training, validation]: [&Part; 2],
    scalers: &Scalers,
) -> Result<Vec<Vec<f32>>, EvalError> {
    let asked = &experiment.windows;
    let set = |part: &Part, stride| {
        let spec = WindowSpec { length: asked.length, reach: asked.reach, stride };
        WindowSet::new(&part.series, windows(&part.series, &spec), asked.length, scalers)
    };
    let (training, validation) = (set(training, asked.stride), set(validation, asked.evaluation_stride));
    let supervise = match asked.target {
        Target::Last => Keep::Last,
        Target::Every => Keep::Every,
    };
    // Whatever device trained it, its weights are the same numbers.
    let device = &device("flex").map_err(ConfigError::from)?;
    let one = |member: usize| {
        let seed = ensemble::seed(record.seed, member);
        let task = Task { network: &experiment.network, training: &experiment.training, supervise, seed, device };
        let network = Network::new(task.network, training.channels(), training.widths().said(), task.seed, task.device);
        let path = ensemble::checkpoint(&request.run.join(format!("checkpoints/{}.safetensors", record.id)), member);
        let progress = checkpoint::read(&path, &Identity::new(&task, &training, &validation), &network)?;
        let missing = || {
            let what = format!("{}: the checkpoint is missing", path.display());
            EvalError::Data(format!("{what}; bring it back, or delete its record and run `acm-train --resume`"))
        };
        Ok(progress.ok_or_else(missing)?.best)
    };
    (0..record.members.len().max(1)).map(one).collect()
}
