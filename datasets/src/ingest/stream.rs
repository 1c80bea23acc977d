//! Trials of a data file, read piece by piece.
//!
//! ```text
//! piece ─┬─ rows of trials that end in it     → trials
//!        └─ rows of trials that go on after it → carried over, put before the next piece
//! ```
//!
//! So a trial may lie anywhere in a file, also between the rows of others, and no more is held than a piece and the
//! trials that are open at its end.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

use crate::error::DataError;
use crate::ingest::layout::{Layout, Naming};
use crate::ingest::recording::{DataFile, Recording};
use crate::ingest::split::{self, Whole};

/// The pieces that have rows of a trial, by its name; empty where a file is one piece, or one trial.
pub(crate) type Spans = BTreeMap<String, Range<usize>>;

/// Finds which trials each piece holds, from the column of names alone.
pub(crate) fn spans(file: &DataFile, layout: &Layout) -> Spans {
    let mut spans = Spans::new();
    if file.pieces() == 1 || !matches!(layout.name, Naming::Column(_)) {
        return spans;
    }
    for piece in 0..file.pieces() {
        let mut labels = file.labels(piece);
        labels.dedup();
        for label in labels {
            spans.entry(label).or_insert(piece..piece).end = piece + 1;
        }
    }
    spans
}

/// A file whose trials come as they are complete.
pub(crate) struct FileTrials<'a> {
    file: DataFile<'a>,
    /// Relative to the data folder.
    name: &'a Path,
    layout: &'a Layout,
    spans: Spans,
    first: usize,
    next: usize,
    carried: Option<Recording>,
    /// Names of trials with a problem.
    refused: Vec<String>,
    /// Recognised properties of the pieces that were read.
    said: BTreeSet<String>,
}

impl<'a> FileTrials<'a> {
    /// The trials that begin in piece `first` or later.
    pub fn new(file: DataFile<'a>, name: &'a Path, layout: &'a Layout, spans: Spans, first: usize) -> Self {
        Self {
            file,
            name,
            layout,
            spans,
            first,
            next: first,
            carried: None,
            refused: Vec::new(),
            said: BTreeSet::new(),
        }
    }

    /// The piece that is read next.
    pub fn next(&self) -> usize {
        self.next
    }

    /// Whether a trial with rows in these pieces is yet to come.
    pub fn will_give(&self, pieces: &Range<usize>) -> bool {
        self.first <= pieces.start && self.next < pieces.end
    }

    /// The pieces that have rows of a trial.
    pub fn span(&self, trial: &str) -> Range<usize> {
        self.spans.get(trial).cloned().unwrap_or(0..self.file.pieces())
    }

    /// Names of the trials that ended and have a problem; each is reported once.
    pub fn take_refused(&mut self) -> Vec<String> {
        std::mem::take(&mut self.refused)
    }

    /// Which pieces hold which trial, and the recognised properties of the file.
    pub fn into_spans(self) -> (Spans, Vec<String>) {
        (self.spans, self.file.notes().iter().cloned().chain(self.said).collect())
    }

    /// Reads a piece and returns the trials that end in it; `None` after the last.
    pub fn read(&mut self, problems: &mut Vec<DataError>) -> Option<Vec<Whole>> {
        if self.next == self.file.pieces() {
            return None;
        }
        let read = self.file.read(self.next, problems);
        self.next += 1;
        let before = self.carried.take();
        let Some(read) = read else { return Some(Vec::new()) };
        self.said.extend(read.said());
        let all = match before {
            Some(before) => before.followed_by(read),
            None => read,
        };
        let Some(groups) = split::groups(&all, self.layout, problems) else {
            self.next = self.file.pieces(); // a file without a name has none in any piece
            return None;
        };
        let (mut ended, mut open) = (Vec::new(), Vec::new());
        for (name, rows) in groups {
            let span = self.span(&name);
            if span.end > self.next {
                open.extend(rows);
            } else if span.start >= self.first {
                match split::trial(&all, self.name, name.clone(), &rows, self.layout, problems) {
                    Some(whole) => ended.push(whole),
                    None => self.refused.push(name),
                }
            }
        }
        self.carried = match open.len() {
            0 => None,
            some if some == all.rows => Some(all),
            _ => {
                open.sort_unstable();
                Some(all.select(&open))
            }
        };
        Some(ended)
    }
}
