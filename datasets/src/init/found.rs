//! Groups of files with the same columns, and the trials that their names give.
//!
//! Files with the same columns are trials of one source. A file that lacks some of them, or has more, joins a group whose names it has.

use std::cmp::Reverse;
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
    pub format: Format,
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
    /// Column that names the trials, and their names.
    pub by: Option<(String, Vec<String>)>,
    /// Of a table.
    pub time: Option<Time>,
}

/// The column of time.
#[derive(Debug)]
pub(super) struct Time {
    pub column: String,
    /// None of a type that carries its own.
    pub unit: Option<String>,
    /// The file does not say the unit.
    pub guessed: bool,
    /// Duration of all files, s.
    pub duration: f64,
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
    fn new(file: File) -> Found {
        let (name, format, ends) = (String::new(), file.format, Default::default());
        Found { name, format, files: vec![file], ends, shared: false, by: None, time: None }
    }

    /// Name of a file's trial.
    pub fn trial<'a>(&self, file: &'a File) -> &'a str {
        let stem = file.stem();
        let inner = stem.strip_prefix(self.ends.0.as_str()).and_then(|stem| stem.strip_suffix(self.ends.1.as_str()));
        inner.unwrap_or(stem)
    }

    pub fn trials(&self) -> BTreeSet<&str> {
        match &self.by {
            Some((_, names)) => names.iter().map(String::as_str).collect(),
            None => self.files.iter().map(|file| self.trial(file)).collect(),
        }
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

    /// A word that the names of its files share, or else the format.
    pub fn set_name(&mut self) {
        let (before, after) = (self.ends.0.as_str(), self.ends.1.as_str());
        let stem = if self.files.len() == 1 { self.files[0].stem() } else { "" };
        let words = if self.format.is_table() { [after, before, stem] } else { [after, "", ""] };
        let plain =
            |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).replace(|c: char| !c.is_alphanumeric(), "_");
        let name = words.into_iter().map(plain).find(|word| !word.is_empty());
        self.name = name.unwrap_or_else(|| self.format.name().to_string());
    }

    /// Whether another group has the same columns.
    fn equals(&self, other: &Found) -> bool {
        let is_same = || self.files[0].columns() == other.files[0].columns();
        self.format == other.format && (!self.format.is_table() || is_same())
    }

    /// Whether another group has names like its own, and half of its columns.
    fn takes(&self, other: &Found) -> bool {
        let (own, others) = (self.files[0].columns(), other.files[0].columns());
        self.format == other.format
            && self.ends != Default::default()
            && other.files.iter().all(|file| self.trial(file) != file.stem())
            && 2 * own.intersection(&others).count() >= own.len().max(others.len())
    }
}

/// A recording; `None` for a file of another kind, and the reason where it cannot be used.
pub(super) fn look_at(folder: &Path, path: &Path) -> Result<Option<File>, String> {
    let (at, reason) = (folder.join(path), |error| first_problem(&folder.join(path), error));
    let Some(name) = path.to_str().filter(|name| !name.contains(char::is_control)) else {
        return Err("its name has control characters or is not UTF-8: rename it".into());
    };
    let Some(format) = formats::recognise(&at).map_err(reason)? else { return Ok(None) };
    let file = File { path: name.to_string(), format, looks: look::columns(&at, format).map_err(reason)? };
    match file.rows() {
        0 | 1 => Err("it has no rows of data".into()),
        _ if file.looks.iter().all(|look| look.kind != Held::Number) => Err("it has no column of numbers".into()),
        _ => Ok(Some(file)),
    }
}

/// The first problem of a file, without its path.
fn first_problem(path: &Path, error: DataError) -> String {
    let problem = error.problems().first().map_or(String::new(), ToString::to_string).replace('\n', " ");
    let problem = problem.strip_prefix(&path.display().to_string()).unwrap_or(&problem);
    problem.trim_start_matches([',', ':', ' ']).to_string()
}

/// Files with the same columns.
pub(super) fn groups(files: Vec<File>) -> Vec<Found> {
    let mut groups = joined(files.into_iter().map(Found::new).collect(), Found::equals);
    for found in &mut groups {
        found.ends = names::common(&found.files.iter().map(File::stem).collect::<Vec<_>>(), false);
    }
    groups.sort_by_key(|found| Reverse(found.files.len()));
    joined(groups, Found::takes)
}

/// Groups to which others that fit are added.
fn joined(groups: Vec<Found>, fits: fn(&Found, &Found) -> bool) -> Vec<Found> {
    let mut kept: Vec<Found> = Vec::new();
    for found in groups {
        match kept.iter_mut().find(|large| fits(large, &found)) {
            Some(large) => large.files.extend(found.files),
            None => kept.push(found),
        }
    }
    for found in &mut kept {
        found.files.sort_by(|a, b| natural::compare(&a.path, &b.path));
    }
    kept
}
