//! `best.json`: every candidate, every step to an average, the choice with its reason, and the held-out score.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{
    average::Step,
    candidate::{self, Candidate},
};
use crate::{
    config::Kind,
    run::record::{DataStamp, FORMAT, PartScores, Versions},
    store::{StoreError, hashed},
};

/// Name of the file, below the folder of the study.
pub const FILE: &str = "best.json";

/// Name of the winner in its scores on held-out trials, beside `nominal` and `polynomial`.
pub const WINNER: &str = "best";

/// The answer, with all that it rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BestRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Kind of the study, [`Kind::Best`].
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// Origin of the numbers.
    pub data: DataStamp,
    /// The code that ran.
    pub versions: Versions,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Units that the folds left out.
    pub folds: String,
    /// The loop's model, where one was named.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub augmented: Option<AugmentedStamp>,
    /// All candidates: models alone, then averages in the order in which they grew.
    pub candidates: Vec<Candidate>,
    /// Candidates of each step to an average.
    pub steps: Vec<Step>,
    /// Factor on the squared error of each model on each fold, for the choice of its epoch ([`super::candidate`]).
    pub optimism: BTreeMap<String, Vec<f64>>,
    /// The one to be used.
    pub winner: Winner,
    /// Caveats, in sentences.
    pub notes: Vec<String>,
}

/// The loop's model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AugmentedStamp {
    /// Path of the file.
    pub file: PathBuf,
    /// SHA-256 of the file, hex.
    pub sha256: String,
    /// Files of the model fitted without the trials of each fold.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub folds: Vec<PathBuf>,
}

/// The chosen model and its score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Winner {
    /// Members of the winner, whose predictions are averaged.
    pub members: Vec<WinnerMember>,
    /// Whether its members were trained to the end; not with `protocol.final = false`.
    pub trained: bool,
    /// Scores on held-out trials: `nominal`, `polynomial`, and [`WINNER`]; none with `protocol.final = false`, and where no
    /// trial is held out.
    pub held_out: Option<PartScores>,
    /// Table of its predictions there, relative to the folder of the study, and its SHA-256, hex.
    pub predictions: Option<(PathBuf, String)>,
}

/// A model of the winner.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WinnerMember {
    /// Name in tables.
    pub name: String,
    /// Run folder, relative to that of the study: that of its final runs, or of runs with the same nominal model, where
    /// that model is all of it.
    pub folder: PathBuf,
    /// Whether anything was learned; if not, it is the nominal model of that folder alone.
    pub learned: bool,
}

impl BestRecord {
    /// Returns the candidate that was chosen.
    pub fn chosen(&self) -> &Candidate {
        candidate::chosen(&self.candidates)
    }
}

/// Reads `best.json` of the folder of a study.
///
/// # Errors
/// The file cannot be read, was changed, or is something else; the message names it.
pub fn read(study: &Path) -> Result<BestRecord, StoreError> {
    hashed::read(&study.join(FILE), FORMAT)
}
