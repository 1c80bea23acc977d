//! Groups of files that hold the same columns, and what their names say of trials.
//!
//! Files with the same columns are trials of one source. A file that lacks some of them, or has more, joins a group whose names it has.

use std::collections::BTreeSet;
use std::path::Path;

use super::column::Column;
use super::look::{self, Look};
use super::names;
use crate::error::DataError;
use crate::formats::{self, Format};
use crate::ingest::recording::Held;
use crate::text::natural;

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

impl File {
    pub fn stem(&self) -> &str {
        let name = self.path.rsplit_once('/').map_or(self.path.as_str(), |(_, name)| name);
        name.rsplit_once('.').map_or(name, |(stem, _)| stem)
    }

    pub fn columns(&self) -> BTreeSet<&str> {
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
    pub fn set_name(&mut self) {
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

    pub fn rows(&self) -> usize {
        self.files.iter().map(File::rows).sum()
    }
}

/// A recording; none for a file of another kind, and the reason where it cannot be used.
pub(super) fn look_at(folder: &Path, path: &Path) -> Result<Option<(Format, File)>, String> {
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
pub(super) fn groups(files: Vec<(Format, File)>) -> Vec<Found> {
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
