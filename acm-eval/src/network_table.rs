//! Comparison with networks, for the gain of a network once the effect is in the model: four models at identical time
//! stamps.
//!
//! | model | error from |
//! | --- | --- |
//! | nominal | runs with the nominal model, before the network |
//! | nominal + effect | runs with the saved model, before the network |
//! | nominal + network | runs with the nominal model |
//! | nominal + effect + network | runs with the saved model |
//!
//! Both experiments differ in `[nominal]` alone, so data, filter, windows, seeds and training are the same.

use std::{
    fs,
    path::{Path, PathBuf},
};

use acm_datasets::{Campaign, Role, files::regular};
use acm_trace::{close::Closed, finding::NetworkRow};
use acm_train::config::{self, Experiment, Nominal, Source};
use acm_train::run::evaluation::held_out::{errors, same_targets};
use acm_train::run::progress::Progress;
use acm_train::run::record::RunRecord;
use acm_train::run::stop::Stop;
use acm_train::schedule::request::Request;
use acm_train::schedule::{ScheduleError, job};

use crate::closed_loop::folder::LoopFolder;
use crate::error::EvalError;
use crate::question::config::LoopConfig;
use crate::spread::Spread;

/// Trainings of a comparison with networks, and their data.
#[derive(Debug)]
pub struct Trainings<'a> {
    /// Experiment as read from its file, with the loop's data and nominal model in the place of its own.
    experiment: Experiment,
    source: Source,
    /// Folder of the tables, where they do not lie beside the manifest.
    data: Option<&'a Path>,
    hash: String,
}

impl<'a> Trainings<'a> {
    /// Returns the trainings that the configuration requests; none where it names no experiment.
    ///
    /// # Errors
    /// The experiment file cannot be used, or would leave nothing to compare: it has no final runs, or the data no
    /// held-out trials.
    pub fn of(
        config: &LoopConfig,
        source: &Source,
        campaign: &Campaign,
        data: Option<&'a Path>,
    ) -> Result<Option<Self>, EvalError> {
        let Some(file) = config.experiment_file(source)? else { return Ok(None) };
        let (mut experiment, source) = config::read(&file, &[])?;
        if !experiment.protocol.final_runs {
            return Err(EvalError::Usage(format!(
                "{}: protocol.final is false, so no network is scored on held-out trials; set it to true, or leave \
                 networks.experiment out",
                file.display()
            )));
        }
        if campaign.trials(Role::HeldOut).next().is_none() {
            return Err(EvalError::Data(format!(
                "{}: no trial has the role `held_out`, on which networks could be compared; give one in [roles] of the \
                 manifest, or leave networks.experiment out",
                campaign.manifest.name
            )));
        }
        experiment.data = campaign.folder.clone();
        experiment.nominal = config.nominal.clone();
        Ok(Some(Self { experiment, source, data, hash: campaign.hash.clone() }))
    }

    /// Trains beside a result that was written to `out`, and writes it again with the rows; returns where its page is.
    ///
    /// # Errors
    /// As [`Trainings::rows`], and a result that cannot be written.
    pub fn add(
        &self,
        closed: &mut Closed,
        out: &LoopFolder,
        progress: &Progress,
        stop: &Stop,
    ) -> Result<PathBuf, EvalError> {
        let model = out.model(closed.finding.confirmation);
        closed.finding.networks = self.rows(&model, &out.networks(), progress, stop)?;
        out.write(closed)
    }

    /// Trains with the nominal model and with `model`, below `out`; errors in SI units.
    ///
    /// Runs that an earlier loop has finished with the same values are taken over.
    ///
    /// # Errors
    /// Anything that ends a training, or that makes the two incomparable.
    pub fn rows(
        &self,
        model: &Path,
        out: &Path,
        progress: &Progress,
        stop: &Stop,
    ) -> Result<Vec<NetworkRow>, EvalError> {
        let comparator_degree = self.experiment.nominal.comparator_degree;
        let augmented = Nominal { augmented: Some(absolute(model)), comparator_degree, ..Nominal::default() };
        let text = regular::read_to_string(model).map_err(|source| EvalError::read(model, source))?;
        let bare = self.train(self.experiment.clone(), "", &out.join("nominal"), progress, stop)?;
        let experiment = Experiment { nominal: augmented, ..self.experiment.clone() };
        let with = self.train(experiment, &text, &out.join("augmented"), progress, stop)?;
        if !same_targets(&bare, &with) {
            return Err(EvalError::Incomparable {
                first: out.join("nominal"),
                second: out.join("augmented"),
                difference: "they were scored at other time stamps".into(),
            });
        }
        rows(&bare, &with).ok_or_else(|| EvalError::NoRecords { path: out.into() })
    }

    fn train(
        &self,
        experiment: Experiment,
        model: &str,
        out: &Path,
        progress: &Progress,
        stop: &Stop,
    ) -> Result<Vec<RunRecord>, EvalError> {
        self.clear(&experiment, model, out)?;
        progress.note(&format!("networks: {}", out.display()));
        let request = Request { data: self.data, resume: true, ..Request::new(out, progress, stop) };
        job::run(experiment, &self.source, &request).map_err(|error| match error {
            ScheduleError::Stopped { folder, finished, planned } => EvalError::Stopped { folder, finished, planned },
            error => error.into(),
        })
    }

    /// Removes the runs of another experiment, and records the present one.
    fn clear(&self, experiment: &Experiment, model: &str, out: &Path) -> Result<(), EvalError> {
        let asked = serde_json::json!({ "experiment": experiment, "data": self.hash, "model": model });
        let note = out.with_extension("json");
        let before: Option<serde_json::Value> =
            fs::read_to_string(&note).ok().and_then(|text| serde_json::from_str(&text).ok());
        if before.is_some_and(|before| before != asked) && out.exists() {
            fs::remove_dir_all(out).map_err(|source| EvalError::write(out, source))?;
        }
        acm_datasets::files::atomic::write_bytes(&note, asked.to_string().as_bytes()).map_err(EvalError::Table)
    }
}

/// Makes a path independent of the experiment file's folder.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.into())
}

/// Returns the mean and standard deviation over seeds of the four models, SI; none where no run was scored.
pub fn rows(bare: &[RunRecord], with: &[RunRecord]) -> Option<Vec<NetworkRow>> {
    let row = |model: &str, spread: Option<Spread>| {
        let Spread { mean, sd } = spread?;
        Some(NetworkRow { model: model.into(), error: mean, sd })
    };
    let [bare, with] = [errors(bare), errors(with)];
    let before = |errors: &[_]| Spread::of_constant(&nominal(errors));
    let after = |errors: &[_]| Spread::of(&network(errors));
    let rows = [
        row("nominal", before(&bare)),
        row("nominal + effect", before(&with)),
        row("nominal + network", after(&bare)),
        row("nominal + effect + network", after(&with)),
    ];
    rows.into_iter().collect()
}

fn nominal(errors: &[acm_train::run::evaluation::held_out::SeedErrors]) -> Vec<f64> {
    errors.iter().map(|error| error.nominal).collect()
}

fn network(errors: &[acm_train::run::evaluation::held_out::SeedErrors]) -> Vec<f64> {
    errors.iter().map(|error| error.network).collect()
}
