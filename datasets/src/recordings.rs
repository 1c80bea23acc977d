//! A data set that was opened and checked: the list of its trials, and the trials themselves, which are held in memory
//! where they are few and read again when they are asked for where they are many.
//!
//! ```text
//! open     each file once, piece by piece: everything is checked, and each trial leaves an Entry
//! trials   the trials of some entries, in the order asked; fast where files hold them in natural order of their names
//! ```

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::campaign::Campaign;
use crate::consistency::{self, Whole};
use crate::entry::{Entry, Place};
use crate::error::{DataError, Problems};
use crate::folds::Folds;
use crate::join::{Alignment, Plan};
use crate::layout::Layout;
use crate::locate::{self, DataFiles};
use crate::manifest::{self, Manifest, Role};
use crate::plausible::{self, Seen};
use crate::recording::{Content, DataFile, Recording, TickType, Wanted};
use crate::stream::{FileTrials, Spans, spans};
use crate::toml_file::TomlSource;
use crate::trial::Trial;
use crate::{cut, folds, natural, split};

/// Samples that [`Options::default`] holds in memory: about 100 MB.
pub const HOLD: usize = 1 << 20;

/// Trials that are read ahead of their turn are let go beyond so many samples.
const AHEAD: usize = 1 << 18;

/// How a data set is opened.
pub struct Options<'a> {
    /// Development and held-out trials without so many samples in a row are problems.
    pub window: Option<usize>,
    /// A longer step in time is a gap, s.
    pub max_gap: f64,
    /// Sets with more samples than these are read again whenever they are asked for.
    pub hold: usize,
    /// Is called with the samples that were read.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { window: None, max_gap: 0.5, hold: HOLD, progress: &|_| {} }
    }
}

/// A data set that was opened and checked.
#[derive(Debug)]
pub struct Recordings {
    /// What the data are.
    pub manifest: Manifest,
    /// All trials, also excluded ones, by name in natural order.
    pub entries: Vec<Entry>,
    /// SHA-256 of the manifest and the data files, hex.
    pub hash: String,
    /// What looks wrong and may be right.
    pub warnings: Vec<String>,
    /// Where the data files lie.
    pub folder: PathBuf,
    /// How the clocks of several sources stand, trial by trial.
    pub alignments: Vec<Alignment>,
    /// What was recognised in the files of several sources, a sentence each.
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

/// What one file gave.
#[derive(Default)]
struct Part {
    wholes: Vec<Whole>,
    entries: Vec<(Entry, Seen)>,
    trials: Vec<Trial>,
    spans: Spans,
    /// The type of the column of time, where it has one of its own.
    time_type: Option<TickType>,
    problems: Vec<DataError>,
    /// What the manifest does not say of its trials.
    misfits: Vec<DataError>,
    digest: Vec<u8>,
}

impl Recordings {
    /// Opens the data set of `folder/manifest.toml`; the data files lie in `data_folder`, or where [`crate::locate`]
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
        let (entries, spans, hash, warnings) = (Vec::new(), Vec::new(), String::new(), Vec::new());
        let mut plan =
            (!manifest.source.list.is_empty()).then(|| Plan::new(&manifest, &source, &folder, &mut problems));
        plan.iter_mut().for_each(|plan| plan.align(&mut problems));
        let alignments = plan.as_ref().map_or(Vec::new(), Plan::alignments);
        let notes = plan.as_ref().map_or(Vec::new(), |plan| plan.notes.clone());
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
        let beside = locate::warnings(&set.folder, &unmatched, &packed);
        set.read_all(options, problems, beside)?;
        Ok(set)
    }

    fn read_all(
        &mut self,
        options: &Options,
        mut problems: Vec<DataError>,
        beside: Vec<String>,
    ) -> Result<(), DataError> {
        let roles = self.manifest.roles.by_trial();
        let samples = AtomicUsize::new(0);
        let read = |file: usize| self.read_file(file, &roles, &samples, options);
        let count = self.plan.as_ref().map_or(self.files.len(), Plan::len);
        let parts: Vec<Part> = (0..count).into_par_iter().map(read).collect();
        drop(roles);
        let digests = match self.plan {
            None => parts.iter().map(|part| part.digest.clone()).collect(),
            Some(_) => self.digests(&mut problems),
        };
        let (hash, complete) =
            (self.hash_of(&digests), parts.iter().all(|p| p.problems.is_empty()) && self.is_aligned());
        let (mut wholes, mut entries, mut trials, mut misfits) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut time_type = None;
        for part in parts {
            wholes.extend(part.wholes);
            entries.extend(part.entries);
            trials.extend(part.trials);
            problems.extend(part.problems);
            misfits.extend(part.misfits);
            time_type = time_type.or(part.time_type);
            self.spans.push(part.spans);
        }
        self.hash = hash;
        let unit_not_used = time_type.and_then(|of| self.unit_not_used(&of));
        entries.sort_by(|a, b| natural::compare(&a.0.name, &b.0.name));
        trials.sort_by(|a, b| natural::compare(&a.name, &b.name));
        let mut seen = Vec::with_capacity(entries.len());
        for (entry, of_trial) in entries {
            self.entries.push(entry);
            seen.push(of_trial);
        }
        self.held = (samples.into_inner() <= options.hold).then_some(trials);
        let whole = complete && problems.is_empty() && misfits.is_empty();
        self.warnings = plausible::warnings(&self.manifest, &self.layout, &seen, whole);
        self.warnings.extend(unit_not_used);
        self.warnings.extend(beside);
        consistency::unique(&wholes, &mut problems);
        problems.extend(misfits);
        let (manifest, source) = (&self.manifest, &self.source);
        if complete {
            // after a file that could not be read, every name in it would be unknown
            consistency::names(manifest, source, &wholes, &self.entries, &mut problems);
            consistency::recorded(&self.entries, &mut problems);
        }
        consistency::folds(manifest, source, &self.entries, &mut problems);
        if let Some(length) = options.window {
            problems.extend(consistency::windows(&self.entries, length, options.max_gap));
            if !problems.is_empty() {
                // A check tells everything at once; what is only suspicious comes after what is wrong.
                problems.extend(self.warnings.drain(..).map(DataError::Warning));
            }
        }
        Problems(problems).into_result()
    }

    /// A unit of time that contradicts the type of the column.
    fn unit_not_used(&self, of: &TickType) -> Option<String> {
        let unit = self.manifest.table.time.unit.as_ref().filter(|unit| **unit != of.unit)?;
        let column = self.manifest.table.time.column.as_deref().unwrap_or_default();
        let place = self.source.place(&["table", "time", "unit"]);
        Some(format!(
            "{place}: column `{column}` is of type {}, which carries its unit; unit = {unit:?} is not used: leave it out",
            of.name
        ))
    }

    fn read_file(&self, file: usize, roles: &BTreeMap<&str, Role>, samples: &AtomicUsize, options: &Options) -> Part {
        if let Some(plan) = &self.plan {
            return self.read_joined(plan, file, roles, samples, options);
        }
        let (mut part, path) = (Part::default(), self.folder.join(&self.files[file]));
        let opened = match DataFile::open(&path, &self.wanted, true) {
            Ok((mut opened, digest)) => {
                part.digest = digest.unwrap_or_default();
                part.problems.extend(opened.take_problems());
                part.time_type = opened.time_type().cloned();
                opened
            }
            Err(error) => {
                part.problems.extend(error.problems());
                return part;
            }
        };
        let spans = spans(&opened, &self.layout);
        let mut trials = FileTrials::new(opened, &self.files[file], &self.layout, spans, 0);
        while let Some(ended) = trials.read(&mut part.problems) {
            let check = |name: String| cut::check_role(&self.manifest, &self.source, roles, &name, &self.files[file]);
            part.misfits.extend(trials.take_refused().into_iter().filter_map(check));
            for whole in ended {
                let pieces = trials.span(&whole.trial.name);
                self.take_whole(whole, file, pieces, roles, samples, options, &mut part);
            }
        }
        part.spans = trials.into_spans();
        part
    }

    /// SHA-256 of each file.
    fn digests(&self, problems: &mut Vec<DataError>) -> Vec<Vec<u8>> {
        let digest = |file: &PathBuf| {
            let path = self.folder.join(file);
            Content::of(&path)?.digest().map_err(|e| DataError::file_system("read", path, &e))
        };
        let all: Vec<Result<Vec<u8>, DataError>> = self.files.par_iter().map(digest).collect();
        let kept = all.into_iter().map(|digest| digest.map_err(|error| problems.push(error)).unwrap_or_default());
        kept.collect()
    }

    /// Whether the clocks of all trials could be brought together.
    fn is_aligned(&self) -> bool {
        self.plan.as_ref().is_none_or(|plan| self.alignments.len() == plan.len() * self.manifest.source.list.len())
    }

    /// A trial that is joined from several sources, and what its parts leave.
    fn read_joined(
        &self,
        plan: &Plan,
        trial: usize,
        roles: &BTreeMap<&str, Role>,
        samples: &AtomicUsize,
        options: &Options,
    ) -> Part {
        let mut part = Part::default();
        let (name, file) = plan.trial(trial);
        let whole = match plan.read(trial) {
            Ok(Some(read)) => {
                let rows: Vec<usize> = (0..read.rows).collect();
                split::trial(&read, file, name.to_string(), &rows, &self.layout, &mut part.problems)
            }
            Ok(None) => None,
            Err(error) => {
                part.problems.extend(error.problems());
                None
            }
        };
        match whole {
            Some(whole) => self.take_whole(whole, trial, 0..1, roles, samples, options, &mut part),
            None => part.misfits.extend(cut::check_role(&self.manifest, &self.source, roles, name, file)),
        }
        part
    }

    /// Leaves the entries of a trial, and the trial itself where it is held.
    #[allow(clippy::too_many_arguments)]
    fn take_whole(
        &self,
        split::Whole { trial: whole, rows }: split::Whole,
        file: usize,
        pieces: std::ops::Range<usize>,
        roles: &BTreeMap<&str, Role>,
        samples: &AtomicUsize,
        options: &Options,
        part: &mut Part,
    ) {
        (options.progress)(whole.samples());
        let held = samples.fetch_add(whole.samples(), Ordering::Relaxed) + whole.samples() <= options.hold;
        part.wholes.push(Whole::of(&whole));
        let place = Place { file, pieces };
        let mut rows = rows.as_slice();
        for trial in cut::roles_and_parts(&self.manifest, &self.source, roles, whole, &mut part.misfits) {
            let (of_part, rest) = rows.split_at(trial.samples()); // parts are in the order of time
            rows = rest;
            let seen = Seen::of(&trial, of_part, &self.layout, part.time_type.is_some());
            let entry = Entry { place: place.clone(), ..Entry::of(&trial, options.max_gap) };
            part.entries.push((entry, seen));
            if held {
                part.trials.push(trial);
            }
        }
    }

    /// SHA-256 over the manifest and each file's name and digest, in sorted order.
    fn hash_of(&self, digests: &[Vec<u8>]) -> String {
        let mut hash = Sha256::new();
        hash.update(Sha256::digest(self.source.text.as_bytes()));
        for (file, digest) in self.files.iter().zip(digests) {
            let name = file.to_string_lossy().replace('\\', "/");
            hash.update((name.len() as u64).to_le_bytes());
            hash.update(name.as_bytes());
            hash.update(digest);
        }
        acm_hashed::hexadecimal(&hash.finalize())
    }

    /// Whether the trials are in memory.
    pub fn is_held(&self) -> bool {
        self.held.is_some()
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

impl From<Recordings> for Campaign {
    /// All trials in memory; of a set that was opened to hold them.
    fn from(set: Recordings) -> Campaign {
        let trials = set.held.unwrap_or_default();
        Campaign { manifest: set.manifest, trials, hash: set.hash, warnings: set.warnings, folder: set.folder }
    }
}

/// Trials that are read as they are asked for.
pub struct Reading<'a> {
    set: &'a Recordings,
    roles: BTreeMap<&'a str, Role>,
    indices: std::vec::IntoIter<usize>,
    /// Names that are still to come.
    waiting: BTreeSet<&'a str>,
    /// The file that is being read, by its index.
    open: Option<(usize, FileTrials<'a>)>,
    /// Trials that were read before their turn.
    ready: BTreeMap<String, Trial>,
}

impl<'a> Iterator for Reading<'a> {
    type Item = Result<Cow<'a, Trial>, DataError>;

    fn next(&mut self) -> Option<Self::Item> {
        let index = self.indices.next()?;
        if let Some(held) = &self.set.held {
            return Some(Ok(Cow::Borrowed(&held[index])));
        }
        let entry = &self.set.entries[index];
        self.waiting.remove(entry.name.as_str());
        let read = self.seek(entry).map(Cow::Owned);
        if read.is_err() {
            self.indices = Vec::new().into_iter(); // one error is the last item
        }
        Some(read)
    }
}

impl<'a> Reading<'a> {
    /// Reads on until the trial has come, from its first piece where it is not on the way.
    fn seek(&mut self, entry: &Entry) -> Result<Trial, DataError> {
        if let Some(trial) = self.ready.remove(&entry.name) {
            return Ok(trial);
        }
        let Place { file, pieces } = &entry.place;
        let set = self.set;
        if let Some(plan) = &set.plan {
            return self.join(plan, *file, entry);
        }
        let on_the_way = self.open.as_ref().is_some_and(|(open, trials)| open == file && trials.will_give(pieces));
        if !on_the_way {
            self.open(*file, pieces.start)?;
        }
        while let Some((_, trials)) = &mut self.open
            && trials.next() < pieces.end
        {
            let mut problems = Vec::new();
            let ended = trials.read(&mut problems).unwrap_or_default().into_iter().map(|whole| whole.trial).collect();
            Problems(problems).into_result()?;
            self.keep(ended, &entry.name);
            if let Some(trial) = self.ready.remove(&entry.name) {
                return Ok(trial);
            }
        }
        let reason = format!("trial `{}` is no longer in it: the file was changed while it was read", entry.name);
        Err(DataError::Damaged { path: self.set.folder.join(&entry.file), reason })
    }

    /// Joins a trial again, which is where its parts are.
    fn join(&mut self, plan: &Plan, index: usize, entry: &Entry) -> Result<Trial, DataError> {
        let (name, file) = plan.trial(index);
        let mut problems = Vec::new();
        if let Some(read) = plan.read(index)? {
            let rows: Vec<usize> = (0..read.rows).collect();
            let whole = split::trial(&read, file, name.to_string(), &rows, &self.set.layout, &mut problems);
            self.keep(whole.into_iter().map(|whole| whole.trial).collect(), &entry.name);
        }
        Problems(problems).into_result()?;
        let reason = format!("trial `{}` is no longer in it: the file was changed while it was read", entry.name);
        let changed = DataError::Damaged { path: self.set.folder.join(file), reason };
        self.ready.remove(&entry.name).ok_or(changed)
    }

    fn open(&mut self, file: usize, piece: usize) -> Result<(), DataError> {
        let set = self.set;
        let (opened, _) = DataFile::open(&set.folder.join(&set.files[file]), &set.wanted, false)?;
        let trials = FileTrials::new(opened, &set.files[file], &set.layout, set.spans[file].clone(), piece);
        self.open = Some((file, trials));
        self.ready.clear();
        Ok(())
    }

    /// Keeps what is still waited for, and no more than [`AHEAD`] samples of it beside the trial `now`.
    fn keep(&mut self, ended: Vec<Trial>, now: &str) {
        let set = self.set;
        for whole in ended {
            // what is wrong with roles and parts was said when the set was opened
            let parts = cut::roles_and_parts(&set.manifest, &set.source, &self.roles, whole, &mut Vec::new());
            let wanted = parts.into_iter().filter(|part| part.name == now || self.waiting.contains(part.name.as_str()));
            self.ready.extend(wanted.map(|part| (part.name.clone(), part)));
        }
        if self.ready.values().map(Trial::samples).sum::<usize>() > AHEAD {
            self.ready.retain(|name, _| name == now);
        }
    }
}
