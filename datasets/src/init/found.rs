//! Contents of a folder: groups of similar files, and their columns.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::error::DataError;
use crate::formats::{self, Format, Keep};
use crate::ingest::recording::Wanted;
use crate::ingest::recording::csv::Csv;

/// Files that look alike.
pub(super) struct Found {
    pub name: String,
    pub format: Format,
    /// File names, sorted.
    pub files: Vec<String>,
    /// Between the trial's name and the extension.
    pub end: String,
    /// Column and unit, as far as the first file says it.
    pub columns: Vec<(String, Option<String>)>,
}

impl Found {
    /// Names of its trials.
    pub fn trials(&self) -> BTreeSet<&str> {
        self.files.iter().map(|file| trial(file, &self.end)).collect()
    }

    /// Whether its one file holds all trials of the reference: there is a trial that it is not named after.
    pub fn is_shared(&self, trials: &BTreeSet<&str>) -> bool {
        self.files.len() == 1 && trials.iter().any(|trial| self.file(trial).is_none())
    }

    /// The file of a trial.
    pub fn file(&self, of: &str) -> Option<&String> {
        self.files.iter().find(|file| trial(file, &self.end) == of)
    }

    /// Column and unit of the time, where one looks like it.
    pub fn time(&self) -> Option<(&str, &str)> {
        let (name, unit) = self.columns.iter().find(|(name, _)| is_time(name))?;
        Some((name, unit.as_deref().unwrap_or("s")))
    }
}

/// Whether a column of a table is named as a time is.
pub(super) fn is_time(name: &str) -> bool {
    ["t", "time", "timestamp", "stamp", "seconds"]
        .contains(&name.to_lowercase().split([' ', '[', '(', '_', '.']).next().unwrap_or_default())
}

/// Name of a file without the end that the files share.
fn trial<'a>(file: &'a str, end: &str) -> &'a str {
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    stem.strip_suffix(end).unwrap_or(stem)
}

pub(super) fn sources(folder: &Path) -> Result<Vec<Found>, DataError> {
    let failed = |e: &std::io::Error| DataError::file_system("read", folder, e);
    let mut groups: BTreeMap<(Format, String), Vec<String>> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).map_err(|e| failed(&e))? {
        let path = entry.map_err(|e| failed(&e))?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()).filter(|_| path.is_file()) else { continue };
        let Some(format) = formats::recognise(&path)? else { continue };
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let end = stem.rfind('_').map_or(String::new(), |at| stem[at..].to_string());
        groups.entry((format, end)).or_default().push(name.to_string());
    }
    let mut sources: Vec<Found> = Vec::new();
    for ((format, end), mut files) in groups {
        files.sort();
        // an end with digits is part of the trial's name
        let end = if end.contains(|c: char| c.is_ascii_digit()) { String::new() } else { end };
        let known = end.trim_start_matches('_').chars().filter(|c| c.is_alphanumeric()).collect::<String>();
        let name = if known.is_empty() { format.name().to_string() } else { known };
        match sources.iter_mut().find(|source| source.format == format && source.end == end) {
            Some(before) => before.files.extend(files),
            None => {
                let columns = columns(&folder.join(&files[0]), format)?;
                sources.push(Found { name, format, files, end, columns });
            }
        }
    }
    Ok(sources)
}

/// Columns of a file and their units.
fn columns(path: &Path, format: Format) -> Result<Vec<(String, Option<String>)>, DataError> {
    match format {
        Format::Csv => {
            let bytes = std::fs::read(path).map_err(|e| DataError::file_system("read", path, &e))?;
            let Csv { names, units, .. } = Csv::new(path, bytes, &Wanted::default())?;
            let units = units.unwrap_or_default();
            Ok(names.into_iter().map(|name| (name.clone(), units.get(&name).cloned())).collect())
        }
        Format::Parquet => Ok(Vec::new()),
        _ => {
            let take = formats::read(path, format, Keep::Nothing)?;
            let columns = take.groups.into_iter().flat_map(|group| group.columns);
            Ok(columns.map(|column| (column.name, column.unit.map(str::to_string))).collect())
        }
    }
}
