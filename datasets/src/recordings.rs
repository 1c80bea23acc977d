//! A data set that was opened and checked: the list of its trials, and the trials themselves, which are held in memory
//! where they are few and read again when they are needed where they are many.
//!
//! ```text
//! open     each file once, piece by piece: everything is checked, and each trial leaves an Entry
//! trials   the trials of some entries, in the order asked; fast where files hold them in natural order of their names
//! ```

mod checked;
mod reading;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::entry::Entry;
use crate::error::DataError;
use crate::folds::{self, Folds};
use crate::ingest::layout::Layout;
use crate::ingest::locate::{self, DataFiles};
use crate::ingest::recording::{Recording, Wanted};
use crate::ingest::stream::Spans;
use crate::join::{Alignment, Line, Plan};
use crate::manifest::{self, Manifest, Role};
use crate::toml_file::TomlSource;
use crate::trial::Trial;

pub use reading::Reading;

/// Samples that [`Options::default`] holds in memory: about 100 MB.
pub const HOLD: usize = 1 << 20;

/// How a data set is opened.
pub struct Options<'a> {
    /// Development and held-out trials without so many samples in a row are problems.
    pub window: Option<usize>,
    /// A longer step in time is a gap, s; by default what [`max_gap`](crate::max_gap) says.
    pub max_gap: Option<f64>,
    /// Sets with more samples than these are read again whenever they are needed.
    pub hold: usize,
    /// Is called with the samples that were read.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { window: None, max_gap: None, hold: HOLD, progress: &|_| {} }
    }
}

/// A data set that was opened and checked.
#[derive(Debug)]
pub struct Recordings {
    /// Manifest of the data.
    pub manifest: Manifest,
    /// All trials, also excluded ones, by name in natural order.
    pub entries: Vec<Entry>,
    /// SHA-256 of the manifest and the data files, hex.
    pub hash: String,
    /// Warnings about implausible data.
    pub warnings: Vec<String>,
    /// Folder of the data files.
    pub folder: PathBuf,
    /// Clock alignment of several sources, trial by trial.
    pub alignments: Vec<Alignment>,
    /// Recognized properties of the files of several sources, one sentence each.
    pub notes: Vec<String>,
    /// Which files make a trial, where there are several sources.
    plan: Option<Plan>,
    /// The trials of the entries, where they are few.
    held: Option<Vec<Trial>>,
    source: TomlSource,
    layout: Layout,
    wanted: Wanted,
    files: Vec<PathBuf>,
    spans: Vec<Spans>,
}

impl Recordings {
    /// Opens the data set of `folder/manifest.toml`; the data files lie in `data_folder`, or where [`crate::ingest::locate`]
    /// finds them.
    ///
    /// The result is the same on any number of threads: files are read side by side and joined in sorted order.
    ///
    /// # Errors
    /// All problems of the manifest; or else all problems of the data.
    pub fn open(folder: &Path, data_folder: Option<&Path>, options: &Options) -> Result<Self, DataError> {
        let (manifest, source) = manifest::read(folder)?;
        let unplanned = || DataError::Usage(format!("{}: the manifest was not validated", source.path.display()));
        let layout = Layout::new(&manifest).ok_or_else(unplanned)?;
        let mut problems = Vec::new();
        let DataFiles { folder, files, unmatched, packed } =
            locate::locate(&manifest, folder, data_folder, &mut problems)?;
        let (wanted, held) = (layout.wanted(), None);
        let (entries, spans, hash) = (Vec::new(), Vec::new(), String::new());
        let mut plan =
            (!manifest.source.list.is_empty()).then(|| Plan::new(&manifest, &source, &folder, &mut problems));
        plan.iter_mut().for_each(|plan| plan.align(&mut problems));
        let alignments = plan.as_ref().map_or(Vec::new(), Plan::alignments);
        let notes = plan.as_ref().map_or(Vec::new(), |plan| plan.notes.clone());
        let warnings = plan.as_mut().map_or(Vec::new(), |plan| std::mem::take(&mut plan.warnings));
        let mut set = Self {
            manifest,
            entries,
            hash,
            warnings,
            folder,
            alignments,
            notes,
            plan,
            held,
            source,
            layout,
            wanted,
            files,
            spans,
        };
        let mut beside = locate::warnings(&set.folder, &unmatched, &packed);
        let left_out = set.plan.iter().flat_map(|plan| &plan.left_out);
        beside.extend(left_out.map(|(trial, why)| format!("trial `{trial}` is excluded, and left out: {why}")));
        set.read_all(options, problems, beside)?;
        Ok(set)
    }

    /// Whether the trials are in memory.
    pub fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// The trials that are in memory, which it then holds no longer.
    pub(crate) fn take_held(&mut self) -> Vec<Trial> {
        self.held.take().unwrap_or_default()
    }

    /// All samples.
    pub fn samples(&self) -> usize {
        self.entries.iter().map(|entry| entry.samples).sum()
    }

    /// The entries of a role.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.role == role)
    }

    /// The folds of the development trials, where an experiment asks for no others ([`crate::folds`]).
    pub fn folds(&self) -> Folds {
        folds::usual(&self.manifest, &self.entries)
    }

    /// Each trial as it was joined from several sources, before its samples take part: name and columns, `time` among them.
    pub(crate) fn joined(&self) -> impl Iterator<Item = Result<(String, Recording), DataError>> {
        let plan = self.plan.as_ref();
        let read = move |i: usize| {
            let plan = plan?;
            let recording = plan.read(i).transpose()?;
            Some(recording.map(|recording| (plan.trial(i).0.to_string(), recording)))
        };
        (0..plan.map_or(0, Plan::len)).filter_map(read)
    }

    /// The columns of a trial as its sources recorded them, on the reference's clock; none of a set of tables.
    ///
    /// # Errors
    /// The files of the trial, which are read again.
    pub fn on_one_clock(&self, trial: &str) -> Result<Vec<Line>, DataError> {
        self.plan.as_ref().map_or(Ok(Vec::new()), |plan| plan.view(trial))
    }

    /// All trials, one after the other.
    pub fn all(&self) -> Reading<'_> {
        self.trials(0..self.entries.len())
    }

    /// The trials of the entries with these indices, in this order.
    pub fn trials(&self, indices: impl IntoIterator<Item = usize>) -> Reading<'_> {
        let indices: Vec<usize> = indices.into_iter().collect();
        let waiting = indices.iter().map(|i| self.entries[*i].name.as_str()).collect();
        let (roles, indices, ready) = (self.manifest.roles.by_trial(), indices.into_iter(), BTreeMap::new());
        Reading { set: self, roles, indices, waiting, open: None, ready }
    }
}
