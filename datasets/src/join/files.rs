//! Assignment of the sources' files to trials.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use regex::Regex;

use crate::error::DataError;
use crate::ingest::locate;
use crate::manifest::Source;
use crate::text::natural;

/// Each trial of the reference with a file of each source; an excluded one that lacks a file goes to `left_out`.
pub(super) fn trials(
    sources: &[Source],
    reference: usize,
    folder: &Path,
    places: &[String],
    excluded: &[String],
    left_out: &mut BTreeMap<String, String>,
    problems: &mut Vec<DataError>,
) -> Vec<(String, Vec<PathBuf>)> {
    let found: Vec<BTreeMap<String, PathBuf>> =
        sources.iter().map(|source| by_trial(source, folder, problems)).collect();
    let mut names: Vec<&String> = found[reference].keys().collect();
    names.sort_by(|a, b| natural::compare(a, b));
    let mut unjoined = |i: usize, trial: &str, what: &str| {
        let (at, trial, of) = (places[i].clone(), trial.to_string(), sources[i].name.clone());
        let problem = DataError::Unjoined { at, trial: trial.clone(), of, what: what.to_string() };
        match excluded.contains(&trial) {
            true => drop(left_out.insert(trial, problem.to_string())),
            false => problems.push(problem),
        }
    };
    for (i, files) in found.iter().enumerate().filter(|(i, _)| !sources[*i].shared) {
        for trial in files.keys().filter(|trial| !found[reference].contains_key(*trial)) {
            unjoined(i, trial, "the reference has no file of this trial; correct `trial`, or move the file away");
        }
    }
    let mut trials = Vec::new();
    for name in names {
        let of = |i: usize| match sources[i].shared {
            true => found[i].values().next().cloned(),
            false => found[i].get(name).cloned(),
        };
        let files: Vec<Option<PathBuf>> = (0..sources.len()).map(of).collect();
        for i in (0..sources.len()).filter(|i| files[*i].is_none()) {
            unjoined(
                i,
                name,
                "it has no file of this trial; correct `files` or `trial`, move the reference's file away, or, where one file \
                 holds all trials, set `shared = true`",
            );
        }
        if let Some(files) = files.into_iter().collect::<Option<Vec<_>>>() {
            trials.push((name.clone(), files));
        }
    }
    trials
}

/// A source's files by the names of their trials.
fn by_trial(source: &Source, folder: &Path, problems: &mut Vec<DataError>) -> BTreeMap<String, PathBuf> {
    let pattern = source.trial.file.as_deref().and_then(|pattern| Regex::new(pattern).ok());
    let mut files = BTreeMap::new();
    let matched: BTreeSet<PathBuf> = source.files.iter().flat_map(|p| locate::matches(folder, p)).collect();
    if source.shared && matched.len() > 1 {
        let message = format!("source `{}` is shared and matches {} files; name one", source.name, matched.len());
        problems.push(DataError::Usage(format!("{}: {message}", folder.display())));
    }
    for path in matched {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = match &pattern {
            None => Some(stem),
            Some(pattern) => pattern.captures(&stem).and_then(|c| c.get(1)).map(|name| name.as_str().to_string()),
        };
        let Some(name) = name else {
            let (path, pattern) = (folder.join(&path), source.trial.file.clone().unwrap_or_default());
            problems.push(DataError::UnnamedTrial { path, pattern });
            continue;
        };
        if let Some(first) = files.insert(name.clone(), path.clone()) {
            problems.push(DataError::TrialInTwoFiles { trial: name, first, second: path });
        }
    }
    files
}
