//! Record of a run: one JSON file per fold or seed, from which every table and figure is drawn.
//!
//! A record says what was asked ([`Experiment`]), of which data ([`DataStamp`]), by which code ([`Versions`]), and what
//! came out ([`PartScores`]). Reports read records and prediction tables; they never train again.
//!
//! ```text
//! runs/<name>/
//!   experiment.toml            what was asked, every default written out
//!   nominal.json               NominalRecord: one calibration per group of trials
//!   records/<id>.json          RunRecord, id = fold0-seed1 or final-seed1
//!   predictions/<id>.parquet   trial, part, time, then per output measured_o, nominal_o, polynomial_o, predicted_o in m
//!   checkpoints/<id>.safetensors
//!   verdict.json               Verdict: whether what was learned is worth it, over the folds
//!   intervals.json             Intervals: what holds the error of a prediction, and how often
//!   poses.json                 Poses: the nominal arm along held-out trials, for drawing
//!   inputs/                    a study: how the inputs were chosen, with inputs.select
//!   training.log               the same lines for the same numbers: no clock, no paths
//! ```
//!
//! `nominal.json` and the records carry their own hash ([`crate::store::hashed`]), a record that of its predictions as well.
//! All lengths are metres. JSON keeps every bit of a float, so a record that is read back equals the one written.

mod adopt;
pub mod predictions;
pub mod training_log;
pub mod versions;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use acm_core::{Calibration, NominalModel};
use serde::{Deserialize, Serialize};

use crate::{
    config::Experiment,
    learn::{Epoch, Projection},
    store::{StoreError, hashed},
};

/// The number in [`RunRecord::format`]: a reader refuses any other. From 2 on a record carries its own hash
/// ([`crate::store::hashed`]) and that of its predictions.
pub const FORMAT: u32 = 2;

/// Record of one trained network: its configuration, its data and its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Name of the run, `fold0-seed1` or `final-seed1`, and of its files.
    pub id: String,
    /// Stage of the protocol that this run belongs to.
    pub stage: Stage,
    /// Seed of the initial weights and of the order of batches.
    pub seed: u64,
    /// The experiment as it was run, defaults included.
    pub experiment: Experiment,
    /// The data it was run on.
    pub data: DataStamp,
    /// The code that ran.
    pub versions: Versions,
    /// Names of the network's inputs, in order.
    pub channels: Vec<String>,
    /// Names of the outputs, in order (`x`, `y`, `z` for a tip).
    pub outputs: Vec<String>,
    /// Number of trained values of the network; of a baseline, its coefficients or leaves.
    pub parameters: usize,
    /// Windows in the training part and in the validation part.
    pub windows: WindowCounts,
    /// Trials of the training part and of the validation part, by name.
    pub split: Split,
    /// Description of the folds; missing in older records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub folds: Option<FoldStamp>,
    /// Epochs in order.
    pub epochs: Vec<Epoch>,
    /// Epoch 0, the nominal model itself, where it is a candidate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub epoch_zero: Option<Epoch>,
    /// Projections of the validation residual on the correction of each epoch, in the order of `epochs`; empty without
    /// an epoch 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub projections: Vec<Projection>,
    /// The epoch whose weights were kept: the one with the smallest validation loss; 0 where the nominal model has that.
    pub best_epoch: usize,
    /// Factor on the network's output, from 0 to 1, chosen on the validation part. Older records have none, and mean 1.
    #[serde(default = "whole")]
    pub factor: f64,
    /// Networks of an ensemble, whose mean was scored; none where one network was trained. `epochs`, `epoch_zero` and
    /// `best_epoch` are then those of the first, `projections` the mean over all, `parameters` the sum.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
    /// Wall-clock time of the training, s. It is the only number that differs between two runs of one seed.
    pub seconds: f64,
    /// Errors on the validation trials, which chose the epoch.
    pub validation: PartScores,
    /// Errors on the held-out trials, which chose nothing. `None` in cross-validation.
    pub held_out: Option<PartScores>,
    /// Table of predictions, relative to the run folder.
    pub predictions: PathBuf,
    /// SHA-256 of that file, hex.
    pub predictions_sha256: String,
}

/// One network of an ensemble.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Member {
    /// Seed of its initial weights and of its order of batches.
    pub seed: u64,
    /// Epoch 0, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub epoch_zero: Option<Epoch>,
    /// Epochs in order.
    pub epochs: Vec<Epoch>,
    /// The epoch whose weights were kept.
    pub best_epoch: usize,
}

fn whole() -> f64 {
    1.0
}

/// Stage of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "snake_case")]
pub enum Stage {
    /// Trained without one fold, and scored on it.
    CrossValidation {
        /// Index of the fold, from 0.
        fold: usize,
    },
    /// Trained on all folds but one, then scored once on the held-out trials.
    Final,
}

/// Origin of the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DataStamp {
    /// Short name, from the manifest.
    pub name: String,
    /// Title in one line.
    pub title: String,
    /// Licence of the data.
    pub licence: String,
    /// Source of the data.
    pub source: String,
    /// Whether a simulator made the data; it is stated wherever the numbers are shown.
    pub synthetic: bool,
    /// SHA-256 of the manifest and all its files, hex.
    pub hash: String,
    /// SI unit of the outputs (`m`).
    pub unit: String,
    /// Use of each trial, by name.
    pub trials: BTreeMap<String, TrialStamp>,
    /// Lower bounds of the error of any estimator, where the data's maker knows them.
    pub floors: Option<Floors>,
    /// Signals that are constant within the development trials and differ between them, each with the number of its
    /// values: a network can use such a value to identify a trial. Older records have none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub constant: BTreeMap<String, usize>,
}

/// Use of one trial.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrialStamp {
    /// Role: `calibration`, `development`, `held_out` or `excluded`.
    pub role: String,
    /// Samples that were used.
    pub samples: usize,
    /// Samples that were not, by reason.
    pub dropped: BTreeMap<String, usize>,
}

/// Errors on the held-out trials that recorded inputs cannot explain; the maker of synthetic data knows them and writes
/// them to `floors.json` beside the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Floors {
    /// Best 3-D RMSE of any function of the recorded inputs and their past, mm.
    pub oracle_mm: f64,
    /// Best RMSE per output, mm, as in `oracle_mm`; empty where only that is known.
    #[serde(default)]
    pub oracle_component_mm: Vec<f64>,
    /// Best 3-D RMSE of any function of the instantaneous inputs, mm.
    pub memoryless_mm: f64,
    /// Best RMSE per output, mm, as in `memoryless_mm`; empty where only that is known.
    #[serde(default)]
    pub memoryless_component_mm: Vec<f64>,
}

/// The code that ran.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Versions {
    /// Version of this crate.
    pub acm: String,
    /// Version of burn.
    pub burn: String,
    /// Commit that the program was built from, where it was built in a checkout.
    pub commit: Option<String>,
}

/// Numbers of windows of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WindowCounts {
    /// Windows the weights were fitted to.
    pub training: usize,
    /// Windows that chose the epoch.
    pub validation: usize,
}

/// Trials that a run learned from, and trials that chose its epoch.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Split {
    /// Trials of the training part.
    pub training: Vec<String>,
    /// Trials of the validation part.
    pub validation: Vec<String>,
    /// Trials that took no part in learning, predicted once at the end; empty in cross-validation.
    pub held_out: Vec<String>,
}

impl Split {
    /// Returns whether all trials are learned from, with the choices of the folds.
    pub fn has_no_validation(&self) -> bool {
        self.validation.is_empty()
    }
}

/// Description of the folds, and of the one that chose the epoch.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FoldStamp {
    /// Unit that was left out: `one altitude left out at a time (3 folds)`.
    pub made: String,
    /// Number of folds.
    pub count: usize,
    /// The one that chose the epoch, from 0.
    pub fold: usize,
    /// Signal whose values are left out one at a time, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value_of: Option<String>,
}

/// Errors of each estimator on one part of the data.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PartScores {
    /// Scores over all trials together, by estimator: `nominal`, `polynomial`, and the network by its kind.
    pub estimators: BTreeMap<String, Score>,
    /// Scores per trial, by estimator.
    pub trials: BTreeMap<String, BTreeMap<String, Score>>,
}

/// Scores of one estimator against the measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Number of target time stamps.
    pub samples: usize,
    /// Root mean square error per output, m.
    pub rmse: Vec<f64>,
    /// Root of the mean squared distance, m.
    pub rmse_total: f64,
    /// Share of the residual's variance explained per output, `1 − Σe²/Σ(r − r̄)²` with r = measured − nominal.
    /// `NaN`-free: where the residual is constant, it is 0.
    pub r2: Vec<f64>,
}

/// `nominal.json`: every calibration of a run folder. Fixed before any network was trained.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct NominalRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// The data calibrated on.
    pub data: DataStamp,
    /// Source of the nominal prediction.
    pub source: NominalSource,
    /// Calibrations, one per group of trials: a single one named `calibration`, or one per fold (`fold0`, …) where the
    /// data have no calibration trials.
    pub calibrations: BTreeMap<String, CalibrationPair>,
    /// Names of all planned runs, so that missing runs are known; older folders have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<String>,
}

/// Source of the nominal prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NominalSource {
    /// A model calibrated here on the calibration trials.
    CalibrationTrials,
    /// A model calibrated here on the training trials of each fold, for want of calibration trials.
    TrainingTrials,
    /// The data's own `[[predicted]]` columns.
    Predicted,
    /// A saved model with effects (`nominal.augmented`), not calibrated here.
    Augmented,
    /// No nominal model: the network learns the measurement itself.
    None,
}

/// The nominal model and its comparator, calibrated on the same trials.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CalibrationPair {
    /// Trials calibrated on.
    pub trials: Vec<String>,
    /// The nominal model; `None` where the prediction is the data's own.
    pub nominal: Option<Calibration>,
    /// The arm within a saved model with effects, whose slopes say how an actuator moves the tip; none elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub saved_arm: Option<NominalModel>,
    /// The polynomial from actuators straight to the outputs.
    pub polynomial: Calibration,
}

impl CalibrationPair {
    /// Returns the arm whose slopes say how an actuator moves the tip; none where the nominal model has no arm.
    pub fn arm(&self) -> Option<&NominalModel> {
        let calibrated = self.nominal.as_ref().map(|fitted| &fitted.model);
        calibrated.or(self.saved_arm.as_ref()).filter(|model| model.is_arm())
    }
}

/// Reads every record of a run folder, ordered by file name.
///
/// # Errors
/// The folder has no records, one cannot be read or was changed, or one is of another format; the message names the file.
pub fn read_records(run: &Path) -> Result<Vec<RunRecord>, StoreError> {
    let folder = run.join("records");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)
        .and_then(|entries| entries.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>())
        .map_err(|source| StoreError::io("read", &folder, source))?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    files.iter().map(|file| read_record(file)).collect()
}

/// Reads one record.
///
/// # Errors
/// As [`read_records`].
pub fn read_record(file: &Path) -> Result<RunRecord, StoreError> {
    let record: RunRecord = hashed::read(file, FORMAT)?;
    named(file, &record.id).map(|()| record)
}

/// Refuses a record under another name. It would be counted twice, or in the place of another.
pub(crate) fn named(file: &Path, id: &str) -> Result<(), StoreError> {
    match file.file_stem().is_some_and(|name| name == id) {
        true => Ok(()),
        false => {
            Err(StoreError::Changed { file: file.into(), why: format!("it is the record of {id}, under another name") })
        }
    }
}

/// Reads `nominal.json` of a run folder.
///
/// # Errors
/// The file cannot be read, was changed or is not a nominal record; the message names it.
pub fn read_nominal(run: &Path) -> Result<NominalRecord, StoreError> {
    hashed::read(&run.join("nominal.json"), FORMAT)
}
