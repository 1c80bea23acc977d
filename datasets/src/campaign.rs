//! A data set that was read and checked: the manifest and all its trials in memory, in SI.

use std::ops::Range;
use std::path::{Path, PathBuf};

use acm_core::nominal::NominalSpec;
use acm_core::observations::Observations;
use nalgebra::DMatrix;

use crate::entry::Entry;
use crate::error::DataError;
use crate::folds;
use crate::folds::Folds;
use crate::join::Alignment;
use crate::manifest::{Manifest, Role};
use crate::preprocessing::channel::Channel;
use crate::recordings::{Options, Recordings};
use crate::trial::Trial;

/// A checked data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Manifest of the data.
    pub manifest: Manifest,
    /// All trials, also excluded ones, by name in natural order.
    pub trials: Vec<Trial>,
    /// SHA-256 of the manifest and the data files, hex.
    pub hash: String,
    /// Warnings about implausible data.
    pub warnings: Vec<String>,
    /// Folder of the data files.
    pub folder: PathBuf,
    /// Clock alignment of several sources, trial by trial.
    pub alignments: Vec<Alignment>,
}

impl Campaign {
    /// Reads the data set of `folder/manifest.toml`; the data files lie in `data_folder`, or where [`crate::ingest::locate`]
    /// finds them.
    ///
    /// The result is the same on any number of threads: files are read side by side and joined in sorted order.
    ///
    /// # Errors
    /// All problems of the manifest; or else all problems of the data.
    pub fn read(folder: &Path, data_folder: Option<&Path>) -> Result<Campaign, DataError> {
        Campaign::read_for(folder, data_folder, None)
    }

    /// As [`Campaign::read`]; development and held-out trials that have no `window` samples in a row without a gap
    /// ([`max_gap`](crate::max_gap)) are problems too.
    ///
    /// # Errors
    /// As [`Campaign::read`].
    pub fn check(
        folder: &Path,
        data_folder: Option<&Path>,
        window: usize,
        max_gap: impl Into<Option<f64>>,
    ) -> Result<Campaign, DataError> {
        Campaign::read_for(folder, data_folder, Some((window, max_gap.into())))
    }

    fn read_for(
        folder: &Path,
        data_folder: Option<&Path>,
        window: Option<(usize, Option<f64>)>,
    ) -> Result<Campaign, DataError> {
        let mut options = Options { hold: usize::MAX, ..Options::default() };
        if let Some((length, max_gap)) = window {
            options = Options { window: Some(length), max_gap, ..options };
        }
        Ok(Recordings::open(folder, data_folder, &options)?.into())
    }

    /// The trials of a role.
    pub fn trials(&self, role: Role) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(move |t| t.role == role)
    }

    /// A trial by name.
    pub fn trial(&self, name: &str) -> Option<&Trial> {
        self.trials.iter().find(|t| t.name == name)
    }

    /// The nominal model that the manifest describes: the strain model of its arm, or a polynomial. Where it has
    /// `[[predicted]]` columns, the user's own prediction stands in each trial's `predicted`.
    pub fn nominal_spec(&self) -> NominalSpec {
        self.manifest.nominal_spec()
    }

    /// The rows of the trials on top of each other: `[T×A]` and, for all markers, `[T×M]`.
    pub fn observations(&self, trials: &[&Trial]) -> Observations {
        let stack = |columns: usize, part: &dyn Fn(&Trial) -> DMatrix<f64>| {
            let rows = trials.iter().map(|t| t.samples()).sum();
            let mut all = DMatrix::zeros(rows, columns);
            let mut start = 0;
            for trial in trials {
                all.rows_mut(start, trial.samples()).copy_from(&part(trial));
                start += trial.samples();
            }
            all
        };
        Observations {
            actuators: stack(self.manifest.actuator.len(), &|t| t.actuators.clone()),
            measured: stack(self.manifest.measured.len(), &|t| t.measured.clone()),
            at: self.manifest.marker_places(),
        }
    }

    /// The folds of the development trials, where an experiment asks for no others ([`crate::folds`]).
    pub fn folds(&self) -> Folds {
        folds::usual(&self.manifest, &self.entries(f64::INFINITY))
    }

    /// Which measured columns are reported: the tip's three, or all outputs.
    pub fn tip_columns(&self) -> Range<usize> {
        self.manifest.tip_columns()
    }

    /// The inputs of these names; all actuators and context signals where the list is empty.
    ///
    /// # Errors
    /// A name that is no input: the message lists the known ones.
    pub fn channels(&self, names: &[String]) -> Result<Vec<Channel>, DataError> {
        let all = crate::preprocessing::channel::default_channels(&self.manifest);
        let (names, entries) = (if names.is_empty() { &all } else { names }, self.entries(f64::INFINITY));
        let parsed = names.iter().map(|n| Channel::parse(n, &self.manifest, &entries));
        parsed.collect::<Result<_, _>>().map_err(|e| DataError::Usage(e.to_string()))
    }

    /// The list of the trials; a step in time over `max_gap` seconds is a gap, or what [`max_gap`](crate::max_gap) says.
    pub fn entries(&self, max_gap: impl Into<Option<f64>>) -> Vec<Entry> {
        let max_gap = max_gap.into();
        self.trials.iter().map(|trial| Entry::of(trial, max_gap)).collect()
    }
}

impl From<Recordings> for Campaign {
    /// All trials in memory; of a set that was opened to hold them.
    fn from(mut set: Recordings) -> Campaign {
        let trials = set.take_held();
        let Recordings { manifest, hash, warnings, folder, alignments, .. } = set;
        Campaign { manifest, trials, hash, warnings, folder, alignments }
    }
}
