//! Sources of one set: groups of files whose names of trials agree, and one file that holds all trials.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::found::{Found, groups, look_at};
use super::{names, signals, time};
use crate::error::DataError;
use crate::formats::Format;
use crate::ingest::locate;
use crate::text::natural;

/// Folders below the given one that are looked into, where it has no recordings itself.
const DEPTH: usize = 3;

/// A folder.
#[derive(Debug, Default)]
pub(super) struct Folder {
    /// The reference is the first.
    pub sources: Vec<Found>,
    /// Files that are no part of the set, and why.
    pub left: Vec<(String, String)>,
}

/// Looks at the files of a folder, or of the folders below it where it has no recordings.
pub(super) fn folder(folder: &Path) -> Result<Folder, DataError> {
    std::fs::read_dir(folder).map_err(|e| DataError::file_system("read", folder, &e))?;
    let mut found = Folder::default();
    for depth in 0..=DEPTH {
        found.take(folder, &locate::matches(folder, &("*/".repeat(depth) + "*")));
        if !found.sources.is_empty() {
            break;
        }
    }
    found.name_trials(folder);
    found.left.sort_by(|a, b| natural::compare(&a.0, &b.0));
    Ok(found)
}

impl Folder {
    /// Looks at some files; those that are no recordings are left.
    fn take(&mut self, folder: &Path, paths: &[PathBuf]) {
        let looked: Vec<_> = paths.par_iter().map(|path| look_at(folder, path)).collect();
        let mut files = Vec::new();
        for (path, looked) in paths.iter().zip(looked) {
            match looked {
                Ok(file) => files.extend(file),
                Err(reason) => self.left.push((path.to_string_lossy().into_owned(), reason)),
            }
        }
        self.relate(groups(files));
    }

    /// The reference, and the sources of the same trials; other files are left.
    fn relate(&mut self, mut groups: Vec<Found>) {
        let most = groups.iter().map(|found| found.files.len()).max();
        if most == Some(1) {
            name_apart(&mut groups);
        }
        for found in &mut groups {
            found.set_name();
            found.time = time::of(found);
        }
        let class = |found: &Found| (found.format >= Format::Ulog, found.format.is_table());
        groups.sort_by_key(|found| {
            (most > Some(1) && found.files.len() == 1, class(found), signals::commands(found), found.name.clone())
        });
        for mut found in groups {
            found.shared = self.sources.first().is_some_and(|first| found.trials().is_disjoint(&first.trials()));
            match self.sources.first().and_then(|reference| found.unlike(reference)) {
                Some(reason) => self.leave(found, &reason),
                None => {
                    while self.sources.iter().any(|source| source.name == found.name) {
                        found.name.push('2');
                    }
                    self.sources.push(found);
                }
            }
        }
    }

    /// A column of trials belongs to [table], which has one kind of files.
    fn name_trials(&mut self, folder: &Path) {
        let Some(reference) = self.sources.first_mut().filter(|source| source.format.is_table()) else { return };
        reference.by = time::trials(folder, reference);
        if reference.by.is_some() {
            reference.time = time::of(reference);
            let reason = format!("its columns are others than those of {}", reference.files[0].path);
            self.sources.split_off(1).into_iter().for_each(|other| self.leave(other, &reason));
        }
    }

    /// Leaves the files of a group.
    fn leave(&mut self, found: Found, reason: &str) {
        self.left.extend(found.files.into_iter().map(|file| (file.path, reason.to_string())));
    }
}

/// One file of each group: the words that its name shares with another are the trial. A name that shares none is that of a log.
fn name_apart(groups: &mut [Found]) {
    let stems: Vec<String> = groups.iter().map(|found| found.files[0].stem().to_string()).collect();
    for (found, stem) in groups.iter_mut().zip(&stems) {
        let others = stems.iter().filter(|other| *other != stem);
        let shared = others.map(|other| names::common(&[stem, other], true)).find(|ends| *ends != Default::default());
        found.ends = match shared {
            Some((before, _)) if !before.is_empty() => (String::new(), stem[before.len() - 1..].to_string()),
            Some((_, after)) => (stem[..=stem.len() - after.len()].to_string(), String::new()),
            None => continue,
        };
    }
}

impl Found {
    /// Why it cannot be a source beside the reference; `None` if it can.
    fn unlike(&self, reference: &Found) -> Option<String> {
        let first = &reference.files[0];
        let is_short = match (&self.time, &reference.time) {
            (Some(own), Some(others)) => own.duration < 0.8 * others.duration,
            _ => 10 * self.rows() < reference.rows(),
        };
        if self.files[0].columns() == first.columns() {
            return Some(format!("a copy of {}", first.path));
        }
        let is_other = self.shared && (self.files.len() > 1 || is_short);
        is_other.then(|| format!("its columns or its times are others than those of {}", first.path))
    }
}
