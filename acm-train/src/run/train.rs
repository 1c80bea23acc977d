//! One run, from its plan to its record and table of predictions.
//!
//! Scalers come from the training part, the epoch from the validation part. The held-out trials are predicted once,
//! after the fit is over.

use std::time::Instant;

use acm_core::display::{DIGITS, significant};
use acm_datasets::DataError;
use acm_datasets::files::table::write_parquet_groups;
use acm_models::{Keep, Network, burn::tensor::Device};
use nalgebra::DMatrix;

use super::data::scored::Scored;
use super::error::RunError;
use super::evaluation::score::{Tally, TrialPrediction};
use super::evaluation::summary;
use super::names;
use super::nominal::group;
use super::plan::{Chosen, Plan};
use super::progress::{Progress, RunProgress};
use super::record::predictions::groups;
use super::record::versions::versions;
use super::record::{FORMAT, Member, PartScores, RunRecord, WindowCounts, read_records};
use super::setting::Setting;
use super::stop::Stop;
use crate::{
    config::{Target, device},
    learn::{
        self, Control, Ended, Epoch, LearnError, Projection, Scalers, Task,
        baseline::{self, Lagged},
        ensemble,
    },
    store::{RunFolder, hashed},
};

/// Outcome of a run.
#[derive(Debug)]
pub enum Outcome {
    /// Run with a record, whose predictions are on the disk already.
    Finished(Box<RunRecord>),
    /// Stopped by the user; the checkpoint is on disk.
    Stopped,
}

/// Trains the network or the baseline of a plan, going on from its checkpoint where there is one, and scores it; progress
/// calls it `name`.
///
/// # Errors
/// The loss is not finite, the checkpoint is of another run, or the file system refuses.
pub fn train(
    setting: &Setting,
    plan: &Plan,
    folder: &RunFolder,
    name: &str,
    progress: &Progress,
    stop: &Stop,
) -> Result<Outcome, RunError> {
    let start = Instant::now();
    let run = Run::new(setting, plan)?;
    let shown = progress.begin(name, setting.experiment.rows());
    if let Some(note) = run.refuse_constant_target()? {
        progress.note(&note);
    }
    let learned = run.learn(folder, &shown, stop)?;
    if learned.ended == Ended::Asked {
        shown.end(&format!("stopped after epoch {}", learned.epochs.len()));
        return Ok(Outcome::Stopped);
    }
    let record = run.finish(learned, folder, start)?;
    shown.end(&outcome(&record));
    Ok(Outcome::Finished(Box::new(record)))
}

/// A plan with its data.
pub(super) struct Run<'a> {
    setting: &'a Setting<'a>,
    plan: &'a Plan,
    pub(super) scalers: Scalers,
    pub(super) training: Scored<'a>,
    pub(super) validation: Scored<'a>,
    held_out: Scored<'a>,
}

/// Result of a fit.
struct Learned {
    model: Model,
    parameters: usize,
    epochs: Vec<Epoch>,
    zero: Option<Epoch>,
    projections: Vec<Projection>,
    best_epoch: usize,
    factor: f64,
    members: Vec<Member>,
    ended: Ended,
}

/// The fitted model.
enum Model {
    Networks(Vec<Network>),
    Baseline(baseline::Model),
}

impl<'a> Run<'a> {
    pub(super) fn new(setting: &'a Setting<'a>, plan: &'a Plan) -> Result<Self, RunError> {
        let asked = &setting.experiment.windows;
        let pair = &setting.nominal.calibrations[&group(&setting.data.manifest, plan)];
        let stride = if setting.experiment.memory.is_trial() { 1 } else { asked.stride };
        let training = Scored::new(setting, pair, &plan.split.training, stride)?;
        let mut scalers = Scalers::of_each(|see| training.each(see))?;
        if setting.experiment.inputs.straight_path && setting.experiment.baseline.is_none() {
            let levels: Vec<bool> = setting.channels.iter().map(|channel| !channel.is_rate()).collect();
            scalers = scalers.with_straight(&levels, |see| training.each(see))?;
        }
        Ok(Self {
            scalers,
            training,
            validation: Scored::new(setting, pair, &plan.split.validation, asked.evaluation_stride)?,
            held_out: Scored::new(setting, pair, &plan.split.held_out, asked.evaluation_stride)?,
            setting,
            plan,
        })
    }

    fn learn(&self, folder: &RunFolder, shown: &RunProgress, stop: &Stop) -> Result<Learned, RunError> {
        let mut observer = |epoch: &Epoch| {
            shown.epoch(epoch);
            if stop.asked() { Control::Stop } else { Control::Continue }
        };
        match &self.setting.experiment.baseline {
            None => self.network(folder, &mut observer),
            Some(asked) => {
                let (training, validation) = (self.lagged(&self.training), self.lagged(&self.validation));
                Ok(baseline::fit(asked, &training, &validation, &mut observer)?.into())
            }
        }
    }

    fn network(&self, folder: &RunFolder, observer: &mut dyn FnMut(&Epoch) -> Control) -> Result<Learned, RunError> {
        let device = device(&self.setting.experiment.device)?;
        let task = self.task(&device);
        let checkpoint = folder.checkpoint(&self.plan.id);
        let training = self.training.training_examples(&self.scalers)?;
        if self.plan.follows_folds() {
            let chosen = Chosen::of(&read_records(folder.root())?);
            let fitted = ensemble::refit_members(&task, &*training, chosen.epochs, &checkpoint, observer);
            let fitted = fitted.map_err(|error| error.in_run(&self.plan.id))?;
            return Ok(Learned::of(fitted, self.plan.seed, chosen.factor));
        }
        let validation = self.validation.scored_examples(&self.scalers)?;
        let fitted = ensemble::fit_members(&task, &*training, &*validation, &checkpoint, observer);
        let fitted = fitted.map_err(|error| error.in_run(&self.plan.id))?;
        let factor = ensemble::factor(&fitted, &*validation);
        Ok(Learned::of(fitted, self.plan.seed, factor))
    }

    /// Returns the fit on a device.
    pub(super) fn task<'t>(&'t self, device: &'t Device) -> Task<'t> {
        let experiment = self.setting.experiment;
        Task {
            network: &experiment.network,
            training: &experiment.training,
            supervise: match experiment.windows.target {
                Target::Last => Keep::Last,
                Target::Every => Keep::Every,
            },
            seed: self.plan.seed,
            device,
        }
    }

    /// Refuses targets of which no output ever changes, since there is nothing to learn. One of several may be
    /// constant: a planar arm has such. A target of 0 is a perfect nominal model, which is reported and no fault.
    fn refuse_constant_target(&self) -> Result<Option<String>, LearnError> {
        let Some(values) = self.training.constant_target() else { return Ok(None) };
        let trials = names::some(&self.plan.split.training, ", ");
        if values.iter().all(|value| *value == 0.0) {
            let same = "its prediction equals what is measured";
            return Ok(Some(format!("warning: the nominal model leaves nothing to learn on {trials}: {same}")));
        }
        let outputs = self.setting.data.manifest.output_names();
        let outputs = outputs.iter().zip(values).map(|(name, value)| format!("{name} is {value}"));
        let outputs = outputs.collect::<Vec<_>>().join(", ");
        Err(LearnError::ConstantTarget { trials, outputs })
    }

    fn lagged<'p>(&self, part: &'p Scored<'_>) -> Lagged<'p> {
        Lagged::new(part.held(), part.windows(), self.setting.experiment.windows.length, &self.scalers)
    }

    fn finish(&self, learned: Learned, folder: &RunFolder, start: Instant) -> Result<RunRecord, RunError> {
        let experiment = self.setting.experiment;
        let (plan, kind) = (self.plan, experiment.kind());
        let outputs = self.setting.data.manifest.output_names();
        let tally = |part: &Scored| Tally::new(part.residuals(), &kind);
        let (mut validation, mut held_out) = (tally(&self.validation), tally(&self.held_out));
        let of_validation = self.predict(&learned, &self.validation)?.map(|trial| {
            let trial = trial?;
            validation.add(&trial);
            Ok(("validation", trial))
        });
        let of_held_out = self.predict(&learned, &self.held_out)?.map(|trial| {
            let trial = trial?;
            held_out.add(&trial);
            Ok(("held_out", trial))
        });
        let path = folder.predictions(&plan.id);
        write_parquet_groups(&path, groups(of_validation.chain(of_held_out), &outputs))?;
        Ok(RunRecord {
            format: FORMAT,
            id: plan.id.clone(),
            stage: plan.stage,
            seed: plan.seed,
            experiment: experiment.clone(),
            data: self.setting.nominal.data.clone(),
            versions: versions(),
            channels: self.setting.channels.iter().map(|channel| channel.name.clone()).collect(),
            outputs,
            parameters: learned.parameters,
            windows: WindowCounts {
                training: self.training.windows().len(),
                validation: self.validation.windows().len(),
            },
            split: plan.split.clone(),
            folds: Some(plan.folds.clone()),
            epochs: learned.epochs,
            epoch_zero: learned.zero,
            projections: learned.projections,
            best_epoch: learned.best_epoch,
            factor: learned.factor,
            members: learned.members,
            seconds: start.elapsed().as_secs_f64(),
            validation: if validation.is_empty() { PartScores::default() } else { validation.scores() },
            held_out: (!held_out.is_empty()).then(|| held_out.scores()),
            predictions: format!("predictions/{}.parquet", plan.id).into(),
            predictions_sha256: hashed::of_file(&path)?,
        })
    }

    /// Returns all estimates at the targets of a part, trial by trial.
    fn predict<'s>(
        &self,
        learned: &Learned,
        part: &'s Scored<'_>,
    ) -> Result<impl Iterator<Item = Result<TrialPrediction, DataError>> + use<'s>, RunError> {
        let residual = match &learned.model {
            _ if part.windows().is_empty() => DMatrix::zeros(0, self.scalers.targets.mean.len()),
            Model::Networks(networks) => {
                let examples = part.scored_examples(&self.scalers)?;
                let networks = networks.iter().map(|network| learn::predict(network, &*examples));
                let refined = learned.factor * ensemble::mean(networks);
                match &self.scalers.straight {
                    None => refined,
                    Some(path) => refined + part.at_targets(|series| path.along(&self.scalers.inputs, series))?,
                }
            }
            Model::Baseline(model) => self.scalers.targets.restore(&model.predict(&self.lagged(part))),
        };
        Ok(part.predictions(residual))
    }
}

impl Learned {
    /// Returns the result of an ensemble or of a single network.
    fn of(fitted: Vec<learn::Fitted>, seed: u64, factor: f64) -> Self {
        let ended = ensemble::ended(&fitted);
        let projections = ensemble::mean_projections(&fitted);
        let mut members: Vec<Member> = fitted
            .iter()
            .enumerate()
            .map(|(m, one)| Member {
                seed: ensemble::seed(seed, m),
                epoch_zero: one.zero,
                epochs: one.epochs.clone(),
                best_epoch: one.best_epoch,
            })
            .collect();
        let Member { epoch_zero: zero, epochs, best_epoch, .. } = members[0].clone();
        if members.len() == 1 {
            members.clear();
        }
        let networks: Vec<Network> = fitted.into_iter().map(|one| one.network).collect();
        let parameters = networks.iter().map(Network::parameter_count).sum();
        Self {
            model: Model::Networks(networks),
            parameters,
            epochs,
            zero,
            projections,
            best_epoch,
            factor,
            members,
            ended,
        }
    }
}

impl From<baseline::Fitted<baseline::Model>> for Learned {
    fn from(fitted: baseline::Fitted<baseline::Model>) -> Self {
        let baseline::Fitted { model, epochs, best_epoch, ended } = fitted;
        let (parameters, model) = (model.parameters(), Model::Baseline(model));
        Self {
            parameters,
            model,
            epochs,
            zero: None,
            projections: vec![],
            best_epoch,
            factor: 1.0,
            members: vec![],
            ended,
        }
    }
}

fn outcome(record: &RunRecord) -> String {
    let (part, scores) = match &record.held_out {
        Some(scores) => ("held-out", scores),
        None => ("validation", &record.validation),
    };
    let error = |name: &str| scores.estimators.get(name).map_or(0.0, |score| score.rmse_total);
    let display = summary::display(&record.data.unit, [scores]);
    format!(
        "best epoch {} of {}{}, {part} error {}, nominal {}, {:.1} s",
        record.best_epoch,
        record.epochs.len(),
        shrunk(record),
        display.show(error(&record.experiment.kind())),
        display.show(error("nominal")),
        record.seconds
    )
}

/// Returns the text on the shrinkage of the network's correction.
fn shrunk(record: &RunRecord) -> String {
    match record.best_epoch {
        0 => " (the nominal model)".into(),
        _ if record.factor < 1.0 => format!(", of which {} is added", significant(record.factor, DIGITS)),
        _ => String::new(),
    }
}
