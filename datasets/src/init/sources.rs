//! Sources of one set: groups of files whose names of trials agree, and one file that holds all trials.

use std::path::Path;

use rayon::prelude::*;

use super::found::{Found, groups, look_at};
use super::{names, signals, time};
use crate::error::DataError;
use crate::formats::Format;
use crate::ingest::locate;
use crate::text::natural;
use crate::units::Unit;

/// Folders below the given one that are looked into, where it has no recordings itself.
const DEPTH: usize = 3;

/// A folder.
#[derive(Debug, Default)]
pub(super) struct Folder {
    /// The reference is the first.
    pub sources: Vec<Found>,
    /// Files that are no part of the set, and why.
    pub left: Vec<(String, String)>,
    /// All files.
    pub paths: Vec<String>,
}

/// Looks at the files of a folder, or of the folders below it where it has no recordings.
pub(super) fn folder(folder: &Path) -> Result<Folder, DataError> {
    std::fs::read_dir(folder).map_err(|e| DataError::file_system("read", folder, &e))?;
    let mut found = Folder::default();
    for depth in 0..=DEPTH {
        let paths = locate::matches(folder, &("*/".repeat(depth) + "*"));
        let looked: Vec<_> = paths.par_iter().map(|path| look_at(folder, path)).collect();
        found.paths = paths.iter().map(|path| path.to_string_lossy().into_owned()).collect();
        let mut files = Vec::new();
        for (path, looked) in found.paths.iter().zip(looked) {
            match looked {
                Ok(file) => files.extend(file),
                Err(reason) => found.left.push((path.clone(), reason)),
            }
        }
        files.sort_by(|a, b| natural::compare(&a.1.path, &b.1.path));
        found.sources = relate(groups(files), &mut found.left);
        if !found.sources.is_empty() {
            break;
        }
    }
    found.left.sort_by(|a, b| natural::compare(&a.0, &b.0));
    Ok(found)
}

/// The reference, and the sources of the same trials; other files are left.
fn relate(mut groups: Vec<Found>, left: &mut Vec<(String, String)>) -> Vec<Found> {
    if groups.iter().all(|found| found.files.len() == 1) {
        name_apart(&mut groups);
    }
    groups.iter_mut().for_each(Found::set_name);
    let most = groups.iter().map(|found| found.files.len()).max();
    let class = |found: &Found| (found.format >= Format::Ulog, found.format.is_table());
    groups.sort_by_key(|found| {
        (most > Some(1) && found.files.len() == 1, class(found), signals::commands(found), found.name.clone())
    });
    let mut sources: Vec<Found> = Vec::new();
    for mut found in groups {
        let Some(reference) = sources.first() else {
            sources.push(found);
            continue;
        };
        let paired = !found.trials().is_disjoint(&reference.trials());
        let copy = paired && sources.iter().any(|source| source.files[0].columns() == found.files[0].columns());
        found.shared = !paired;
        if copy || (found.shared && found.unlike(reference)) {
            let reason = if copy { "a copy of" } else { "its columns or its times are others than those of" };
            left.extend(
                found.files.into_iter().map(|file| (file.path, format!("{reason} {}", reference.files[0].path))),
            );
        } else {
            while sources.iter().any(|source| source.name == found.name) {
                found.name.push('2');
            }
            sources.push(found);
        }
    }
    sources
}

/// One file of each group: what all names share is the trial. A name that shares neither its first nor its last word is that of a log.
fn name_apart(groups: &mut [Found]) {
    let all: Vec<String> = groups.iter().map(|found| found.files[0].stem().to_string()).collect();
    let ends = |stem: &str| {
        let words: Vec<String> = stem.split(|c: char| !c.is_alphanumeric()).map(str::to_string).collect();
        (words.first().cloned(), words.last().cloned())
    };
    let shares = |stem: &&String| {
        let own = ends(stem);
        all.iter().filter(|other| other != stem).map(|other| ends(other)).any(|end| end.0 == own.0 || end.1 == own.1)
    };
    let stems: Vec<&str> = all.iter().filter(shares).map(String::as_str).collect();
    let (before, after) = names::split(&stems, &|_| true);
    for (found, stem) in groups.iter_mut().zip(&all).filter(|(_, stem)| stems.contains(&stem.as_str())) {
        found.ends = match (before.len(), after.len()) {
            (1.., _) => (String::new(), stem[before.len() - 1..].to_string()),
            (_, 1..) => (stem[..=stem.len() - after.len()].to_string(), String::new()),
            _ => found.ends.clone(),
        };
    }
}

impl Found {
    /// Duration of all its files, s; `None` if no column is time.
    fn duration(&self) -> Option<f64> {
        let time = time::of(self, None)?;
        let factor = Unit::parse(time.unit.as_deref().unwrap_or("s")).map_or(1.0, |unit| unit.factor());
        let columns = self.columns();
        let looks = &columns.iter().find(|column| column.name == time.column)?.looks;
        Some(looks.iter().map(|look| factor * (look.high - look.low)).sum())
    }

    /// Why its one file does not hold all trials of the reference; `None` if it may.
    fn unlike(&self, reference: &Found) -> bool {
        match (self.duration(), reference.duration()) {
            _ if self.files.len() > 1 => true,
            (Some(own), Some(others)) => own < 0.8 * others,
            _ => 10 * self.rows() < reference.rows(),
        }
    }
}
