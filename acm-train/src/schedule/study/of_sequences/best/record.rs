//! `best.json` of a choice among questions about sequences: every candidate, the steps to an average, and the winner's test scores.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::config::Kind;
use crate::run::record::{FORMAT, Versions};
use crate::run::sequences::record::DataRecord;
use crate::run::sequences::scores::Scores;
use crate::schedule::study::best::{average::Step, candidate::Candidate, record::FILE};
use crate::store::{StoreError, hashed};

/// The answer, with all that it rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BestOfSequences {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Kind of the study, [`Kind::Best`].
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// Source of the sequences.
    pub sequences: DataRecord,
    /// The code that ran.
    pub versions: Versions,
    /// Loss that chose: `MSE`, in the square of the targets' unit, or `cross-entropy`, in nats.
    pub loss: String,
    /// Whole sequences of the validation part.
    pub units: usize,
    /// All candidates: alone, then averages in the order in which they grew.
    pub candidates: Vec<Candidate>,
    /// Candidates of each step to an average.
    pub steps: Vec<Step>,
    /// Scores of the winner on the test part; left out where no test was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub test: Option<Tested>,
}

/// Scores on the test part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tested {
    /// Scores of the winner.
    pub winner: Scores,
    /// Name of the prediction without a network.
    pub constant_name: String,
    /// Scores of that prediction.
    pub constant: Scores,
    /// Table of the winner's predictions, relative to the folder of the study.
    pub predictions: PathBuf,
    /// SHA-256 of that file, hex.
    pub predictions_sha256: String,
}

/// Reads `best.json` of the folder of a study.
///
/// # Errors
/// The file cannot be read, was changed, or is something else; the message names it.
pub fn read(study: &Path) -> Result<BestOfSequences, StoreError> {
    hashed::read(&study.join(FILE), FORMAT)
}
