//! One run: from a plan to its record and its table of predictions.
//!
//! Scalers come from the training part, the epoch from the validation part. The held-out trials are predicted once,
//! after the fit is over.

use std::time::Instant;

use acm_datasets::{Campaign, Channel, Window, table::write_parquet};
use acm_models::Keep;
use nalgebra::DMatrix;

use crate::{
    error::TrainError,
    experiment::{Experiment, Target},
    folder::RunFolder,
    learn::{Control, Ended, Fitted, Scalers, Task, WindowSet, device, fit, predict},
    nominal::group,
    plan::Plan,
    predictions::columns,
    prepare::Part,
    progress::{Progress, RunProgress},
    record::{CalibrationPair, FORMAT, NominalRecord, RunRecord, WindowCounts},
    score::{TrialPrediction, part_scores},
    stop::Stop,
    versions::versions,
};

/// What all runs of a job share.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// What is asked.
    pub experiment: &'a Experiment,
    /// Of which data, after the domain filter.
    pub campaign: &'a Campaign,
    /// The network's inputs.
    pub channels: &'a [Channel],
    /// The calibrations.
    pub nominal: &'a NominalRecord,
}

/// How a run ended.
#[derive(Debug)]
pub enum Outcome {
    /// With a record, whose predictions are on the disk already.
    Finished(Box<RunRecord>),
    /// Because somebody asked; the checkpoint is on the disk.
    Stopped,
}

/// Trains the network of a plan, going on from its checkpoint where there is one, and scores it; progress calls it `name`.
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
) -> Result<Outcome, TrainError> {
    let start = Instant::now();
    let run = Run::new(setting, plan);
    let shown = progress.begin(name, setting.experiment.training.epochs);
    let fitted = run.fit(folder, &shown, stop)?;
    if fitted.ended == Ended::Asked {
        shown.end(&format!("stopped after epoch {}", fitted.epochs.len()));
        return Ok(Outcome::Stopped);
    }
    let record = run.finish(fitted, folder, start)?;
    shown.end(&outcome(&record));
    Ok(Outcome::Finished(Box::new(record)))
}

/// A plan with its data.
struct Run<'a> {
    setting: &'a Setting<'a>,
    plan: &'a Plan,
    scalers: Scalers,
    training: WindowSet,
    validation: Scored,
    held_out: Scored,
}

/// A part with the windows that it is scored on.
struct Scored {
    part: Part,
    windows: Vec<Window>,
}

impl<'a> Run<'a> {
    fn new(setting: &'a Setting<'a>, plan: &'a Plan) -> Self {
        let asked = &setting.experiment.windows;
        let pair = &setting.nominal.calibrations[&group(setting.campaign, plan)];
        let training = setting.part(&plan.split.training, pair);
        let scored = |names: &[String]| {
            let part = setting.part(names, pair);
            Scored { windows: part.windows(asked, asked.evaluation_stride), part }
        };
        let scalers = Scalers::of(&training.series);
        let windows = training.windows(asked, asked.stride);
        Self {
            training: WindowSet::new(&training.series, windows, asked.length, &scalers),
            validation: scored(&plan.split.validation),
            held_out: scored(&plan.split.held_out),
            setting,
            plan,
            scalers,
        }
    }

    fn fit(&self, folder: &RunFolder, shown: &RunProgress, stop: &Stop) -> Result<Fitted, TrainError> {
        let experiment = self.setting.experiment;
        let task = Task {
            network: &experiment.network,
            training: &experiment.training,
            supervise: match experiment.windows.target {
                Target::Last => Keep::Last,
                Target::Every => Keep::Every,
            },
            seed: self.plan.seed,
            device: &device(&experiment.device)?,
        };
        let mut observer = |epoch: &_| {
            shown.epoch(epoch);
            if stop.asked() { Control::Stop } else { Control::Continue }
        };
        let checkpoint = folder.checkpoint(&self.plan.id);
        Ok(fit(&task, &self.training, &self.windows(&self.validation), Some(&checkpoint), &mut observer)?)
    }

    fn windows(&self, scored: &Scored) -> WindowSet {
        let length = self.setting.experiment.windows.length;
        WindowSet::new(&scored.part.series, scored.windows.clone(), length, &self.scalers)
    }

    fn finish(&self, fitted: Fitted, folder: &RunFolder, start: Instant) -> Result<RunRecord, TrainError> {
        let validation = self.predict(&fitted, &self.validation);
        let held_out = self.predict(&fitted, &self.held_out);
        let outputs = self.setting.campaign.manifest.output_names();
        let table = columns(&[("validation", &validation), ("held_out", &held_out)], &outputs);
        write_parquet(&folder.predictions(&self.plan.id), &table)?;
        let experiment = self.setting.experiment;
        let (plan, kind) = (self.plan, experiment.kind());
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
            parameters: fitted.network.parameter_count(),
            windows: WindowCounts { training: self.training.len(), validation: self.validation.windows.len() },
            split: plan.split.clone(),
            epochs: fitted.epochs,
            best_epoch: fitted.best_epoch,
            seconds: start.elapsed().as_secs_f64(),
            validation: part_scores(&validation, &kind),
            held_out: (!held_out.is_empty()).then(|| part_scores(&held_out, &kind)),
            predictions: format!("predictions/{}.parquet", plan.id).into(),
        })
    }

    /// All estimates at the targets of a part, trial by trial.
    fn predict(&self, fitted: &Fitted, scored: &Scored) -> Vec<TrialPrediction> {
        if scored.windows.is_empty() {
            return vec![];
        }
        let residual = predict(&fitted.network, &self.windows(scored));
        let of_trial = |index: usize| {
            let (rows, ends): (Vec<usize>, Vec<usize>) = (scored.windows.iter().enumerate())
                .filter(|(_, window)| window.series == index)
                .map(|(row, window)| (row, window.end))
                .unzip();
            scored.part.at(index, &ends, residual.select_rows(&rows))
        };
        (0..scored.part.series.len()).map(of_trial).filter(|trial| !trial.time.is_empty()).collect()
    }
}

impl Setting<'_> {
    fn part(&self, names: &[String], pair: &CalibrationPair) -> Part {
        Part::new(names, self.campaign, pair, self.channels, self.experiment)
    }
}

impl Part {
    /// The estimates of one trial at the samples `ends`, where the network adds `residual` [N×O].
    fn at(&self, index: usize, ends: &[usize], residual: DMatrix<f64>) -> TrialPrediction {
        let series = &self.series[index];
        let nominal = series.nominal.select_rows(ends);
        TrialPrediction {
            trial: series.trial.clone(),
            time: ends.iter().map(|&end| series.time[end]).collect(),
            measured: series.measured.select_rows(ends),
            polynomial: self.polynomial[index].select_rows(ends),
            predicted: &nominal + residual,
            nominal,
        }
    }
}

fn outcome(record: &RunRecord) -> String {
    let (part, scores) = match &record.held_out {
        Some(scores) => ("held-out", scores),
        None => ("validation", &record.validation),
    };
    let error = |name: &str| scores.estimators.get(name).map_or(0.0, |score| score.rmse_total);
    let unit = &record.data.unit;
    format!(
        "best epoch {} of {}, {part} error {:.5} {unit} of {:.5} {unit}, {:.1} s",
        record.best_epoch,
        record.epochs.len(),
        error(&record.experiment.kind()),
        error("nominal"),
        record.seconds
    )
}
