//! The one pass over all files when a set is opened: each is read side by side, and what they gave is joined in sorted order.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::{Options, Recordings};
use crate::checks::consistency::{self, Whole};
use crate::checks::plausible::{self, Seen};
use crate::entry::{Entry, Place};
use crate::error::{DataError, Problems};
use crate::ingest::recording::{Content, DataFile, TickType};
use crate::ingest::stream::{FileTrials, Spans, spans};
use crate::ingest::{cut, split};
use crate::join::Plan;
use crate::manifest::Role;
use crate::text::natural;
use crate::trial::Trial;

/// Contents of one file.
#[derive(Default)]
struct Part {
    wholes: Vec<Whole>,
    entries: Vec<(Entry, Seen)>,
    trials: Vec<Trial>,
    spans: Spans,
    /// The type of the column of time, where it has one of its own.
    time_type: Option<TickType>,
    problems: Vec<DataError>,
    /// Mismatches of manifest and trials.
    misfits: Vec<DataError>,
    /// Recognised properties of the file.
    notes: Vec<String>,
    digest: Vec<u8>,
}

impl Recordings {
    /// Reads and checks all files.
    pub(super) fn read_all(
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
        let (mut time_type, mut notes) = (None, BTreeSet::new());
        for part in parts {
            wholes.extend(part.wholes);
            entries.extend(part.entries);
            trials.extend(part.trials);
            problems.extend(part.problems);
            misfits.extend(part.misfits);
            time_type = time_type.or(part.time_type);
            notes.extend(part.notes);
            self.spans.push(part.spans);
        }
        self.hash = hash;
        self.notes.extend(notes);
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
        self.warnings.extend(plausible::warnings(&self.manifest, &self.layout, &seen, whole));
        self.warnings.extend(unit_not_used);
        self.warnings.extend(beside);
        self.warnings.extend(consistency::repeated(&wholes, &self.entries));
        consistency::unique(&wholes, &mut problems);
        problems.extend(misfits);
        let (manifest, source) = (&self.manifest, &self.source);
        if complete {
            // after a file that could not be read, every name in it would be unknown
            let left_out = self.plan.iter().flat_map(|plan| plan.left_out.keys()).map(String::as_str).collect();
            consistency::names(manifest, source, left_out, &wholes, &self.entries, &mut problems);
            consistency::recorded(manifest, &self.entries, &mut problems);
        }
        consistency::folds(manifest, source, &self.entries, &mut problems);
        if let Some(length) = options.window {
            problems.extend(consistency::windows(&self.entries, length));
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
        let opened = match DataFile::open(&path, None, &self.wanted, true) {
            Ok((mut opened, digest)) => {
                part.digest = digest.unwrap_or_default();
                part.problems.extend(opened.take_problems());
                part.problems.extend(self.other_units(&path, &opened.units()));
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
        (part.spans, part.notes) = trials.into_spans();
        part
    }

    /// Columns whose file says another unit than the manifest.
    fn other_units(&self, path: &Path, written: &BTreeMap<String, String>) -> Vec<DataError> {
        let time = &self.manifest.table.time;
        let clock = time.column.iter().zip(&time.unit).map(|(column, unit)| (column.clone(), unit.clone()));
        let signals = self.manifest.signal_columns().into_iter().map(|(_, _, column, unit)| (column, unit));
        let check =
            |(column, unit): (String, String)| DataError::other_unit(path, &column, written.get(&column), &unit);
        signals.chain(clock).filter_map(check).collect()
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
        let held = samples.fetch_add(whole.recorded(), Ordering::Relaxed) + whole.recorded() <= options.hold;
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
}
