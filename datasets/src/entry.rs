//! Summary of a trial without its samples: one line in the list of a data set.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use crate::levels::Level;
use crate::manifest::Role;
use crate::preprocessing::segments::segments;
use crate::trial::{DropReason, Trial};

/// A trial in the list of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Name, unique in the set.
    pub name: String,
    /// Role of the trial.
    pub role: Role,
    /// Number of samples.
    pub samples: usize,
    /// Samples of its longest stretch without a gap.
    pub longest: usize,
    /// Mean and spread of each actuator, then of each context signal.
    pub levels: Vec<Level>,
    /// Constants, SI.
    pub conditions: BTreeMap<String, f64>,
    /// Samples that were left out, by reason.
    pub dropped: BTreeMap<DropReason, usize>,
    /// File relative to the data folder.
    pub file: PathBuf,
    /// Where its rows stand.
    pub(crate) place: Place,
}

/// Which pieces of which file hold a trial.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Place {
    /// Index of the file.
    pub file: usize,
    /// Its pieces that have rows of the trial.
    pub pieces: Range<usize>,
}

impl Entry {
    /// The line of a trial; a step in time over `max_gap` seconds is a gap.
    pub fn of(trial: &Trial, max_gap: f64) -> Self {
        let columns = trial.actuators.column_iter().chain(trial.context.column_iter());
        Self {
            name: trial.name.clone(),
            role: trial.role,
            samples: trial.samples(),
            longest: segments(&trial.time, max_gap).iter().map(ExactSizeIterator::len).max().unwrap_or(0),
            levels: columns.map(|column| Level::of(column.iter())).collect(),
            conditions: trial.conditions.clone(),
            dropped: trial.dropped.clone(),
            file: trial.file.clone(),
            place: Place::default(),
        }
    }
}
