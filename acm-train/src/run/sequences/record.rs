//! Records of runs on sequences: `study.json` for all, one record a run.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use acm_datasets::sequences::SequenceSet;
use serde::{Deserialize, Serialize};

use super::scores::{self, Scores};
use crate::{
    config::{Elapsed, Kind, Question, QuestionData},
    learn::Epoch,
    run::record::{Member, Versions, named},
    store::{StoreError, hashed},
};

/// The number in [`SequenceRecord::format`] and [`StudyRecord::format`].
pub const FORMAT: u32 = crate::run::record::FORMAT;

/// `study.json`: the question and its sequences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Kind of the study: `sequences`.
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the question.
    pub config: String,
    /// Source of the sequences.
    pub data: DataRecord,
}

/// Source of the sequences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DataRecord {
    /// Title in one line.
    pub title: String,
    /// Whether a generator made the data.
    pub synthetic: bool,
    /// SHA-256 of all sequences, hex.
    pub hash: String,
    /// Names of the inputs.
    pub channels: Vec<String>,
    /// Names of the targets.
    pub outputs: Vec<String>,
    /// Number of sequences of each part, by name.
    pub sequences: BTreeMap<String, usize>,
    /// The largest accuracy without elapsed times, where that is known.
    pub limit_without_time: Option<f64>,
    /// RMSE of the test part if the last value is repeated, by output; where targets are later values of inputs.
    pub persistence: Option<Vec<f64>>,
}

/// Record of one trained network: its question, its sequences and its results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Name of the run, `measured-seed1`, and of its files.
    pub id: String,
    /// Elapsed times that the network received.
    pub elapsed: Elapsed,
    /// Seed of the initial weights and of the order of batches.
    pub seed: u64,
    /// The question as it was run, defaults included.
    pub question: Question,
    /// Source of the sequences.
    pub data: DataRecord,
    /// The code that ran.
    pub versions: Versions,
    /// Number of trained values of the network.
    pub parameters: usize,
    /// Epochs in order.
    pub epochs: Vec<Epoch>,
    /// The epoch whose weights were kept: the one with the smallest validation loss.
    pub best_epoch: usize,
    /// Networks of an ensemble, whose mean was scored; none where one network was trained. `epochs` and `best_epoch` are
    /// then those of the first, `parameters` the sum.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
    /// Wall-clock time of the training, s.
    pub seconds: f64,
    /// Scores on the validation sequences, which chose the epoch.
    pub validation: Scores,
    /// Scores on the test sequences; left out without a test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub test: Option<Scores>,
    /// Table of predictions, relative to the run folder.
    pub predictions: PathBuf,
    /// SHA-256 of that file, hex.
    pub predictions_sha256: String,
}

impl SequenceRecord {
    /// Returns the scores of the test part, or where it was not scored, of the validation part.
    pub fn scored(&self) -> &Scores {
        self.test.as_ref().unwrap_or(&self.validation)
    }
}

impl DataRecord {
    /// Returns the stamp of the sequences of a question.
    pub fn new(question: &Question, set: &SequenceSet) -> Self {
        let (title, ahead, limit) = match &question.data {
            QuestionData::BitStreamXor(asked) => {
                let title = format!("parity of streams of up to {} bits, as events", asked.length - 1);
                (title, 0, Some(acm_datasets::sequences::bit_stream::limit::limit(asked.length)))
            }
            QuestionData::Table(asked) => (format!("tables {}", asked.files.join(" ")), asked.ahead, None),
        };
        Self {
            title,
            synthetic: matches!(question.data, QuestionData::BitStreamXor(_)),
            hash: set.hash(),
            channels: set.channels.clone(),
            outputs: set.outputs.clone(),
            sequences: set.parts().into_iter().map(|(part, of)| (part.to_string(), of.len())).collect(),
            limit_without_time: limit,
            persistence: (ahead > 0).then(|| scores::persistence(set)).flatten(),
        }
    }
}

/// Reads one record.
///
/// # Errors
/// The file cannot be read, is no record, or is of another format; the message names it.
pub fn read(file: &Path) -> Result<SequenceRecord, StoreError> {
    let record: SequenceRecord = hashed::read(file, FORMAT)?;
    named(file, &record.id).map(|()| record)
}

/// Reads `study.json`.
///
/// # Errors
/// As [`read`].
pub fn read_study(file: &Path) -> Result<StudyRecord, StoreError> {
    hashed::read(file, FORMAT)
}
