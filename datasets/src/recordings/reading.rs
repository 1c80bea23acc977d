//! Reading the trials of a set one after the other, from memory or again from disk.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::Recordings;
use crate::entry::{Entry, Place};
use crate::error::{DataError, Problems};
use crate::ingest::cut;
use crate::ingest::recording::DataFile;
use crate::ingest::split;
use crate::ingest::stream::FileTrials;
use crate::join::Plan;
use crate::manifest::Role;
use crate::trial::Trial;

/// Samples of trials read ahead above which they are released.
const AHEAD: usize = 1 << 18;

/// Trials that are read on demand.
pub struct Reading<'a> {
    pub(super) set: &'a Recordings,
    pub(super) roles: BTreeMap<&'a str, Role>,
    pub(super) indices: std::vec::IntoIter<usize>,
    /// Names that are still to come.
    pub(super) waiting: BTreeSet<&'a str>,
    /// The file that is being read, by its index.
    pub(super) open: Option<(usize, FileTrials<'a>)>,
    /// Trials that were read before their turn.
    pub(super) ready: BTreeMap<String, Trial>,
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
        let (opened, _) = DataFile::open(&set.folder.join(&set.files[file]), None, &set.wanted, false)?;
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
        if self.ready.values().map(Trial::recorded).sum::<usize>() > AHEAD {
            self.ready.retain(|name, _| name == now);
        }
    }
}
