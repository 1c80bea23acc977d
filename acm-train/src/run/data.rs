//! The trials of an experiment, within its domain filter: held in memory where they are few, read again at each use
//! where they are many.
//!
//! Both give the same trials in the same order, so that what is computed from them has the same bits. [`prepare`] lists the
//! targets, [`scored`] holds a part of a split, [`range`] checks the inputs, [`shuffle`] permutes them.

pub mod examples;
pub mod prepare;
pub mod range;
pub mod scored;
pub mod shuffle;

use std::{
    borrow::Cow,
    collections::BTreeSet,
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_core::observations::Observations;
use acm_datasets::{Campaign, DataError, Domain, DomainFilter, Entry, Manifest, Recordings, Role, Trial, folds};
use nalgebra::DMatrix;

use crate::config::Windows;

/// Largest number of samples that a nominal model is calibrated on: of more, every k-th.
pub const CALIBRATION_SAMPLES: usize = 1 << 17;

/// Storage of the trials. Clones share it.
#[derive(Debug, Clone)]
pub enum Trials {
    /// Trials in memory, without the samples that the domain filter removes.
    Held(Arc<Campaign>),
    /// Trials on the disk; the domain filter acts whenever they are read.
    Streamed(Arc<Recordings>, Arc<Domain>),
}

/// A data set, and the list of its trials as the domain filter leaves them.
#[derive(Debug)]
pub struct Data {
    /// Manifest of the data.
    pub manifest: Manifest,
    /// Folder of the data files.
    pub folder: PathBuf,
    /// SHA-256 of the manifest and the data files, hex.
    pub hash: String,
    /// All trials, also excluded ones, by name in natural order.
    pub entries: Vec<Entry>,
    trials: Trials,
    /// Piece of each entry.
    pieces: Vec<Piece>,
}

/// A trial, or a block of it.
#[derive(Debug, Clone)]
struct Piece {
    trial: usize,
    block: Option<Block>,
}

/// Part of a trial.
#[derive(Debug, Clone)]
struct Block {
    name: String,
    rows: Range<usize>,
    /// Whether the inputs before it are part of it.
    has_past: bool,
}

impl Piece {
    /// Returns the piece of a trial; dropped samples are counted with the first piece.
    fn of<'t>(&self, trial: Cow<'t, Trial>) -> Cow<'t, Trial> {
        let Some(Block { name, rows, has_past }) = &self.block else { return trial };
        let mut block = match has_past {
            true => trial.select_with_past(rows.clone()),
            false => trial.select(&rows.clone().collect::<Vec<_>>()),
        };
        block.name.clone_from(name);
        if rows.start > 0 {
            block.dropped.clear();
        }
        Cow::Owned(block)
    }
}

impl Trials {
    /// Returns the trials that stay on the disk, within the domain of the calibration trials.
    ///
    /// # Errors
    /// A hull of more than two actuators; a trial that cannot be read.
    pub fn streamed(set: Recordings, filter: DomainFilter) -> Result<Self, DataError> {
        let calibrating = set.entries.iter().enumerate().filter(|(_, entry)| entry.role == Role::Calibration);
        let calibrating: Vec<usize> = calibrating.map(|(index, _)| index).collect();
        let domain = Domain::fit_stream(filter, || set.trials(calibrating.iter().copied()))?;
        Ok(Self::Streamed(Arc::new(set), Arc::new(domain)))
    }

    fn entries(&self, max_gap: Option<f64>) -> Result<Vec<Entry>, DataError> {
        match self {
            Self::Held(campaign) => Ok(campaign.entries(max_gap)),
            Self::Streamed(set, _) => {
                self.read(0..set.entries.len()).map(|trial| Ok::<_, DataError>(Entry::of(&*trial?, max_gap))).collect()
            }
        }
    }

    fn description(&self) -> (&Manifest, &Path, &str) {
        match self {
            Self::Held(campaign) => (&campaign.manifest, &campaign.folder, &campaign.hash),
            Self::Streamed(set, _) => (&set.manifest, &set.folder, &set.hash),
        }
    }

    fn read(&self, indices: impl Iterator<Item = usize>) -> impl Iterator<Item = Result<Cow<'_, Trial>, DataError>> {
        let (held, streamed) = match self {
            Self::Held(campaign) => (Some(indices.map(|index| Ok(Cow::Borrowed(&campaign.trials[index])))), None),
            Self::Streamed(set, domain) => {
                (None, Some(set.trials(indices).map(|trial| Ok(Cow::Owned(domain.keep(&*trial?))))))
            }
        };
        held.into_iter().flatten().chain(streamed.into_iter().flatten())
    }
}

impl Data {
    /// Returns the trials with their list. Where `windows` does not say what a gap is, the trials that are learned from or calibrate
    /// decide, and `windows` notes it.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn new(trials: Trials, windows: &mut Windows) -> Result<Self, DataError> {
        let mut entries = trials.entries(windows.max_gap)?;
        let learns = |entry: &&Entry| matches!(entry.role, Role::Calibration | Role::Development);
        let gap = entries.iter().filter(learns).map(|entry| entry.max_gap).fold(windows.gap(), f64::max);
        if entries.iter().any(|entry| entry.max_gap.to_bits() != gap.to_bits()) {
            entries = trials.entries(Some(gap))?;
        }
        windows.max_gap = Some(gap);
        let (manifest, folder, hash) = trials.description();
        let (manifest, folder, hash) = (manifest.clone(), folder.to_path_buf(), hash.to_string());
        let pieces = (0..entries.len()).map(|trial| Piece { trial, block: None }).collect();
        Ok(Self { manifest, folder, hash, entries, trials, pieces })
    }

    /// Returns whether all trials are in memory.
    pub fn is_held(&self) -> bool {
        matches!(self.trials, Trials::Held(_))
    }

    /// Returns the trials of these names, in natural order.
    pub fn trials(&self, names: &[String]) -> impl Iterator<Item = Result<Cow<'_, Trial>, DataError>> {
        let pieces: Vec<&Piece> = self.indices(names).into_iter().map(|index| &self.pieces[index]).collect();
        let read = self.trials.read(pieces.clone().into_iter().map(|piece| piece.trial));
        read.zip(pieces).map(|(trial, piece)| trial.map(|trial| piece.of(trial)))
    }

    fn indices(&self, names: &[String]) -> Vec<usize> {
        let names: BTreeSet<&str> = names.iter().map(String::as_str).collect();
        let entries = self.entries.iter().enumerate();
        entries.filter(|(_, entry)| names.contains(entry.name.as_str())).map(|(index, _)| index).collect()
    }

    /// Returns the entries of a role.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.role == role)
    }

    /// Cuts the trials of these names into blocks of time, `count` of about as many samples each, which are trials from then on
    /// ([`acm_datasets::folds::block`]). Where they `have_past`, each includes the inputs before it.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn cut(&mut self, names: &[String], count: usize, max_gap: f64, have_past: bool) -> Result<(), DataError> {
        let (mut entries, mut pieces) = (vec![], vec![]);
        for (index, entry) in self.entries.iter().enumerate() {
            if !names.contains(&entry.name) {
                entries.push(entry.clone());
                pieces.push(Piece { trial: index, block: None });
                continue;
            }
            for trial in self.trials.read(std::iter::once(index)) {
                let trial = trial?;
                for number in 0..count {
                    let rows = number * trial.samples() / count..(number + 1) * trial.samples() / count;
                    let block = Block { name: folds::block(&trial.name, number), rows, has_past: have_past };
                    let piece = Piece { trial: index, block: Some(block) };
                    entries.push(Entry::of(&piece.of(Cow::Borrowed(&trial)), Some(max_gap)));
                    pieces.push(piece);
                }
            }
        }
        (self.entries, self.pieces) = (entries, pieces);
        Ok(())
    }

    /// Returns the samples for a calibration on these trials: all, or [`CALIBRATION_SAMPLES`] evenly spread over them.
    ///
    /// # Errors
    /// A trial that cannot be read.
    pub fn observations(&self, names: &[String]) -> Result<Observations, DataError> {
        let total: usize = self.indices(names).into_iter().map(|index| self.entries[index].samples).sum();
        let kept = total.min(CALIBRATION_SAMPLES);
        let mut actuators = DMatrix::zeros(kept, self.manifest.actuator.len());
        let mut measured = DMatrix::zeros(kept, self.manifest.measured.len());
        let mut wanted = (0..kept).map(|row| (row, row * total / kept)).peekable();
        let mut start = 0;
        for trial in self.trials(names) {
            let trial = trial?;
            while let Some((row, sample)) = wanted.next_if(|(_, sample)| *sample < start + trial.samples()) {
                actuators.row_mut(row).copy_from(&trial.actuators.row(sample - start));
                measured.row_mut(row).copy_from(&trial.measured.row(sample - start));
            }
            start += trial.samples();
        }
        Ok(Observations { actuators, measured, at: self.manifest.marker_places() })
    }
}
