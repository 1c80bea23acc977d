//! Contents of a folder: groups of files that hold the same columns, and what their names say of trials.
//!
//! Files with the same columns are trials of one source. A file that lacks some of them, or has more, joins a group whose names it has.
//! Groups whose names of trials agree are sources of the same trials, and one file beside many holds all of them.

use std::collections::BTreeSet;
use std::path::Path;

use rayon::prelude::*;

use super::look::{self, Look};
use super::signals::{self, Column};
use super::{names, time};
use crate::error::DataError;
use crate::formats::{self, Format};
use crate::ingest::locate;
use crate::ingest::recording::Held;
use crate::text::natural;
use crate::units::Unit;

/// Folders below the given one that are looked into, where it has no recordings itself.
const DEPTH: usize = 3;

/// One recording.
#[derive(Debug)]
pub(super) struct File {
    /// Path below the folder.
    pub path: String,
    pub looks: Vec<Look>,
}

/// Files of one kind.
#[derive(Debug)]
pub(super) struct Found {
    pub name: String,
    pub format: Format,
    /// In the order of their paths.
    pub files: Vec<File>,
    /// Around the name of the trial in the name of a file.
    pub ends: (String, String),
    /// Its one file holds all trials.
    pub shared: bool,
}

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

impl File {
    fn stem(&self) -> &str {
        let name = self.path.rsplit_once('/').map_or(self.path.as_str(), |(_, name)| name);
        name.rsplit_once('.').map_or(name, |(stem, _)| stem)
    }

    fn columns(&self) -> BTreeSet<&str> {
        self.looks.iter().map(|look| look.name.as_str()).collect()
    }

    fn rows(&self) -> usize {
        self.looks.iter().map(|look| look.rows).max().unwrap_or(0)
    }
}

impl Found {
    /// Name of a file's trial.
    pub fn trial<'a>(&self, file: &'a File) -> &'a str {
        let stem = file.stem();
        let inner = stem.strip_prefix(self.ends.0.as_str()).and_then(|stem| stem.strip_suffix(self.ends.1.as_str()));
        inner.unwrap_or(stem)
    }

    /// Whether another group has names like its own, and half of its columns.
    fn takes(&self, other: &Found) -> bool {
        let (own, others) = (self.files[0].columns(), other.files[0].columns());
        let (before, after) = &self.ends;
        let named = |file: &File| file.stem().starts_with(before.as_str()) && file.stem().ends_with(after.as_str());
        self.format == other.format
            && !(before.is_empty() && after.is_empty())
            && other.files.iter().all(named)
            && 2 * own.intersection(&others).count() >= own.len().max(others.len())
    }

    /// A word that the names of its files share, or else the format.
    fn set_name(&mut self) {
        let stem = if self.files.len() == 1 && self.ends == Default::default() { self.files[0].stem() } else { "" };
        let table = self.format.is_table();
        let words = [self.ends.1.as_str(), if table { &self.ends.0 } else { "" }, if table { stem } else { "" }];
        let plain =
            |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).replace(|c: char| !c.is_alphanumeric(), "_");
        let name = words.into_iter().map(plain).find(|word| !word.is_empty());
        self.name = name.unwrap_or_else(|| self.format.name().to_string());
    }

    pub fn trials(&self) -> BTreeSet<&str> {
        self.files.iter().map(|file| self.trial(file)).collect()
    }

    /// The file of a trial.
    pub fn file(&self, trial: &str) -> Option<&File> {
        self.files.iter().find(|file| self.shared || self.trial(file) == trial)
    }

    /// Every column, in the order in which the files have them.
    pub fn columns(&self) -> Vec<Column<'_>> {
        let mut columns: Vec<Column> = Vec::new();
        for look in self.files.iter().flat_map(|file| &file.looks) {
            match columns.iter_mut().find(|column| column.name == look.name) {
                Some(column) => column.looks.push(look),
                None => columns.push(Column { name: &look.name, looks: vec![look], files: self.files.len() }),
            }
        }
        columns
    }

    fn rows(&self) -> usize {
        self.files.iter().map(File::rows).sum()
    }

    /// Duration of all its files, s; none where no column is time.
    fn duration(&self) -> Option<f64> {
        let time = time::of(self, None)?;
        let factor = Unit::parse(time.unit.as_deref().unwrap_or("s")).map_or(1.0, |unit| unit.factor());
        let columns = self.columns();
        let looks = &columns.iter().find(|column| column.name == time.column)?.looks;
        Some(looks.iter().map(|look| factor * (look.high - look.low)).sum())
    }

    /// Why its one file does not hold all trials of the reference; none where it may.
    fn unlike(&self, reference: &Found) -> bool {
        match (self.duration(), reference.duration()) {
            _ if self.files.len() > 1 => true,
            (Some(own), Some(others)) => own < 0.8 * others,
            _ => 10 * self.rows() < reference.rows(),
        }
    }
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

/// A recording; none for a file of another kind, and the reason where it cannot be used.
fn look_at(folder: &Path, path: &Path) -> Result<Option<(Format, File)>, String> {
    let said = |e: DataError| {
        let problems = e.problems();
        let more =
            if problems.len() > 1 { format!(" (and {} more problems)", problems.len() - 1) } else { String::new() };
        let first = problems.first().map_or(String::new(), ToString::to_string).replace('\n', " ");
        let at = [folder.join(path), path.to_path_buf()]
            .iter()
            .find_map(|at| first.strip_prefix(&format!("{}", at.display())));
        at.map_or(first.as_str(), |rest| rest.trim_start_matches([',', ':', ' '])).to_string() + &more
    };
    let Some(name) = path.to_str().filter(|name| !name.contains(char::is_control)) else {
        return Err("its name has control characters or is not UTF-8: rename it".into());
    };
    let Some(format) = formats::recognise(&folder.join(path)).map_err(said)?.filter(|_| name != "manifest.toml") else {
        return Ok(None);
    };
    let looks = look::columns(&folder.join(path), format).map_err(said)?;
    let file = File { path: name.to_string(), looks };
    match file.rows() {
        0 | 1 => Err("it has no rows of data".into()),
        _ if file.looks.iter().all(|look| look.kind != Held::Number) => Err("it has no column of numbers".into()),
        _ => Ok(Some((format, file))),
    }
}

/// Files with the same columns.
fn groups(files: Vec<(Format, File)>) -> Vec<Found> {
    let mut groups: Vec<Found> = Vec::new();
    for (format, file) in files {
        let alike = |found: &&mut Found| {
            found.format == format && (!format.is_table() || found.files[0].columns() == file.columns())
        };
        match groups.iter_mut().find(alike) {
            Some(found) => found.files.push(file),
            None => groups.push(Found {
                name: String::new(),
                format,
                files: vec![file],
                ends: Default::default(),
                shared: false,
            }),
        }
    }
    for found in &mut groups {
        found.ends = names::common(&found.files.iter().map(File::stem).collect::<Vec<_>>());
    }
    groups.sort_by_key(|found| std::cmp::Reverse(found.files.len()));
    let mut kept: Vec<Found> = Vec::new();
    for found in groups {
        match kept.iter_mut().find(|large| large.takes(&found)) {
            Some(large) => {
                large.files.extend(found.files);
                large.files.sort_by(|a, b| natural::compare(&a.path, &b.path));
            }
            None => kept.push(found),
        }
    }
    kept
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
