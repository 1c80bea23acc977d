//! One run folder, read and checked: records, calibrations, prediction tables.

mod agreement;
pub mod missing;
pub mod predictions;

use std::path::{Path, PathBuf};

use acm_train::config::Experiment;
use acm_train::run::evaluation::intervals::{self, Intervals};
use acm_train::run::nominal::poses::{self, Poses};
use acm_train::run::record::{NominalRecord, PartScores, RunRecord, Stage};
use acm_train::schedule::study::record::StudyRecord;
use acm_train::schedule::study::{self, eliminate};

use crate::error::EvalError;
use crate::json::versioned;
use crate::run::agreement::{agrees, complete};
use crate::run::predictions::{Predictions, unchanged};

/// One run: one experiment, trained once per fold or seed.
#[derive(Debug)]
pub struct Run {
    /// The folder, as given.
    pub folder: PathBuf,
    /// Name of the experiment, the last part of the folder.
    pub name: String,
    /// Records in the order of stage (folds first), then seed. At least one.
    pub records: Vec<RunRecord>,
    /// Calibrations of the nominal model.
    pub nominal: NominalRecord,
    /// Prediction tables, one per record, in the same order.
    pub predictions: Vec<Predictions>,
    /// Choice of the inputs, where the run made one.
    pub choice: Option<(StudyRecord, Vec<Vec<RunRecord>>)>,
    /// Intervals of its predictions, where enough trials were left out in turn.
    pub intervals: Option<Intervals>,
    /// Poses of its nominal arm along held-out trials, where the nominal model is one.
    pub poses: Option<Poses>,
}

impl Run {
    /// Reads a run folder.
    ///
    /// # Errors
    /// Not a run folder, a record or table that is missing, damaged or of another format, or records that do not
    /// belong together.
    pub fn read(folder: &Path) -> Result<Self, EvalError> {
        let mut records = records(folder)?;
        records.iter().try_for_each(|record| complete(record, folder))?;
        records.sort_by_key(|record| (record.stage, record.seed));
        let predictions = records
            .iter()
            .map(|record| {
                let path = folder.join(&record.predictions);
                unchanged(&path, &record.predictions_sha256)?;
                let table = Predictions::read(&path, &record.outputs)?;
                agrees(record, &table, &path)?;
                Ok(table)
            })
            .collect::<Result<_, EvalError>>()?;
        let nominal = versioned(&folder.join("nominal.json"))?;
        let inner = folder.join(eliminate::FOLDER);
        let choice = inner.join("study.json").is_file().then(|| study::record::read(&inner)).transpose()?;
        let (intervals, poses) = (intervals::read(folder)?, poses::read(folder)?);
        let (name, folder) = (name_of(folder), folder.into());
        let run = Self { folder, name, records, nominal, predictions, choice, intervals, poses };
        run.belongs_together()?;
        Ok(run)
    }

    /// Returns the name of the learned model in the scores: the network's kind (`mlp`, `gru`, `cfc`), or that of the
    /// outside baseline in its place (`ridge`, `boosted_trees`).
    pub fn kind(&self) -> String {
        self.records[0].experiment.kind()
    }

    /// Records with their tables that were trained on all folds but one and scored on the held-out trials, by seed.
    pub fn finals(&self) -> impl Iterator<Item = (&RunRecord, &Predictions)> {
        self.records.iter().zip(&self.predictions).filter(|(record, _)| record.stage == Stage::Final)
    }

    /// Returns the records of the cross-validation, by fold.
    pub fn folds(&self) -> impl Iterator<Item = (usize, &RunRecord)> {
        self.records.iter().filter_map(|record| match record.stage {
            Stage::CrossValidation { fold } => Some((fold, record)),
            Stage::Final => None,
        })
    }

    /// Scores on the held-out trials, by seed.
    pub fn held_out(&self) -> impl Iterator<Item = &PartScores> {
        self.finals().filter_map(|(record, _)| record.held_out.as_ref())
    }

    /// Checks that all records have the same data, outputs and network.
    fn belongs_together(&self) -> Result<(), EvalError> {
        let first = &self.records[0];
        if self.nominal.data.hash != first.data.hash {
            let reason = format!("nominal.json and record {} differ in the hash of the data", first.id);
            return Err(EvalError::Mixed { path: self.folder.clone(), reason });
        }
        for record in &self.records[1..] {
            let what = if record.data.hash != first.data.hash {
                "the hash of the data"
            } else if record.outputs != first.outputs {
                "the outputs"
            } else if record.experiment.network != first.experiment.network {
                "the network"
            } else if record.experiment.baseline != first.experiment.baseline {
                "the baseline"
            } else if settings(record) != settings(first) {
                "the settings of the experiment"
            } else {
                continue;
            };
            let reason = format!("records {} and {} differ in {what}", first.id, record.id);
            return Err(EvalError::Mixed { path: self.folder.clone(), reason });
        }
        Ok(())
    }
}

/// Returns the experiment without the words of the question.
fn settings(record: &RunRecord) -> Experiment {
    Experiment { question: String::new(), ..record.experiment.clone() }
}

/// Returns the last part of a folder's path.
pub fn name_of(folder: &Path) -> String {
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let full = || folder.canonicalize().ok().and_then(|path| name(&path));
    name(folder).or_else(full).unwrap_or_else(|| folder.display().to_string())
}

/// Reads every `records/*.json`.
fn records(folder: &Path) -> Result<Vec<RunRecord>, EvalError> {
    if !folder.is_dir() {
        return Err(EvalError::NoFolder { path: folder.into() });
    }
    let inside = folder.join("records");
    if !inside.is_dir() {
        return Err(EvalError::NotARun { path: folder.into(), missing: "records/" });
    }
    let entries = std::fs::read_dir(&inside).map_err(|source| EvalError::read(&inside, source))?;
    let mut records = Vec::new();
    for entry in entries {
        let file = entry.map_err(|source| EvalError::read(&inside, source))?.path();
        if file.extension().is_some_and(|extension| extension == "json") {
            let record: RunRecord = versioned(&file)?;
            if file.file_stem().is_none_or(|name| name != record.id.as_str()) {
                let reason = format!("it is the record of {}, under another name", record.id);
                return Err(EvalError::Record { file, reason });
            }
            records.push(record);
        }
    }
    match records.is_empty() {
        true => Err(EvalError::NoRecords { path: folder.into() }),
        false => Ok(records),
    }
}
