//! Summary of a trial without its samples: one line in the list of a data set.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use crate::levels::Level;
use crate::manifest::Role;
use crate::preprocessing::increments::Increments;
use crate::preprocessing::segments::{max_gap, segments, usual_step};
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
    /// Largest number of samples that lead up to one of them without a gap, including those without an output.
    pub longest: usize,
    /// Longest step in time that is not a gap, s.
    pub max_gap: f64,
    /// Mean and spread of each actuator, then of each context signal.
    pub levels: Vec<Level>,
    /// Increments of the same signals.
    pub increments: Vec<Increments>,
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
    /// Returns the line of a trial; a step in time over `given` seconds is a gap, or what [`max_gap`] says.
    pub fn of(trial: &Trial, given: Option<f64>) -> Self {
        let (whole, rows) = trial.with_unmeasured();
        let max_gap = max_gap(given, usual_step(&whole.time));
        let samples = |segment: std::ops::Range<usize>| {
            let last = rows[..rows.partition_point(|row| *row < segment.end)].last();
            last.filter(|last| segment.contains(*last)).map_or(0, |last| last + 1 - segment.start)
        };
        let columns = trial.actuators.column_iter().chain(trial.context.column_iter());
        Self {
            name: trial.name.clone(),
            role: trial.role,
            samples: trial.samples(),
            longest: segments(&whole.time, max_gap).into_iter().map(samples).max().unwrap_or(0),
            max_gap,
            levels: columns.clone().map(|column| Level::of(column.iter())).collect(),
            increments: columns.map(|column| Increments::of(column.as_slice())).collect(),
            conditions: trial.conditions.clone(),
            dropped: trial.dropped.clone(),
            file: trial.file.clone(),
            place: Place::default(),
        }
    }
}
