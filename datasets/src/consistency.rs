//! What the manifest and the recordings must agree on: trials, roles, folds, conditions, and lengths.

use std::collections::BTreeMap;

use crate::error::DataError;
use crate::manifest::{Manifest, Role};
use crate::series::segments;
use crate::toml_file::TomlSource;
use crate::trial::Trial;

/// Fewer samples are no recording.
const LEAST_SAMPLES: usize = 2;

/// A trial's name is unique, and no two trials hold the same values.
pub(crate) fn unique(trials: &[Trial], problems: &mut Vec<DataError>) {
    let mut names: BTreeMap<&str, &Trial> = BTreeMap::new();
    let mut values: BTreeMap<Vec<u64>, &Trial> = BTreeMap::new();
    for trial in trials {
        if let Some(first) = names.insert(&trial.name, trial) {
            let (first, second) = (first.file.clone(), trial.file.clone());
            problems.push(DataError::TrialInTwoFiles { trial: trial.name.clone(), first, second });
        }
        if trial.samples() < 2 {
            continue;
        }
        if let Some(first) = values.insert(fingerprint(trial), trial).filter(|f| same(f, trial)) {
            problems.push(DataError::RepeatedTrial {
                first: first.name.clone(),
                first_file: first.file.clone(),
                second: trial.name.clone(),
                second_file: trial.file.clone(),
            });
        }
    }
}

/// The first and the last outputs, by bits: enough to tell nearly all trials apart.
fn fingerprint(trial: &Trial) -> Vec<u64> {
    let last = trial.samples() - 1;
    let row = |t: usize| trial.measured.row(t).iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    [vec![last as u64], row(0), row(last / 2), row(last)].concat()
}

fn same(a: &Trial, b: &Trial) -> bool {
    a.measured == b.measured && a.actuators == b.actuators && a.context == b.context
}

/// Roles, cuts, folds and conditions name trials that exist.
pub(crate) fn names(
    manifest: &Manifest,
    source: &TomlSource,
    read: &[String],
    trials: &[Trial],
    problems: &mut Vec<DataError>,
) {
    let known = |names: &mut dyn Iterator<Item = &str>| names.collect::<Vec<_>>().join(" ");
    let whole = known(&mut read.iter().map(String::as_str));
    let parts = known(&mut trials.iter().map(|t| t.name.as_str()));
    let mut unknown = |key: &[&str], section, trial: &str, known: &str| {
        let (trial, known) = (trial.to_string(), known.to_string());
        problems.push(DataError::UnknownTrial { at: source.place(key), section, trial, known });
    };
    for role in Role::ALL {
        for (i, name) in manifest.roles.of(role).iter().enumerate().filter(|(_, n)| !read.contains(n)) {
            unknown(&["roles", role.name(), &i.to_string()], "[roles]", name, &whole);
        }
    }
    for name in manifest.cut.keys().filter(|n| !read.contains(n)) {
        unknown(&["cut", name], "[cut]", name, &whole);
    }
    for name in manifest.conditions.keys().filter(|n| !read.contains(n) && trials.iter().all(|t| t.name != **n)) {
        unknown(&["conditions", name], "[conditions]", name, &parts);
    }
    for (f, fold) in manifest.folds.validation.iter().enumerate() {
        for (i, name) in fold.iter().enumerate().filter(|(_, n)| trials.iter().all(|t| t.name != **n)) {
            unknown(&["folds", "validation", &f.to_string(), &i.to_string()], "[folds]", name, &parts);
        }
    }
}

/// Each fold has trials that the networks may learn from, and no trial is in two folds.
pub(crate) fn folds(manifest: &Manifest, source: &TomlSource, trials: &[Trial], problems: &mut Vec<DataError>) {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for (f, fold) in manifest.folds.validation.iter().enumerate() {
        let number = f.to_string();
        let mut bad = |key: &[&str], what: String, remedy| {
            problems.push(DataError::BadFold { at: source.place(key), what, remedy });
        };
        if fold.is_empty() {
            bad(
                &["folds", "validation", &number],
                format!("fold {f} has no trials"),
                "name its validation trials or delete it",
            );
        }
        for (i, name) in fold.iter().enumerate() {
            let key = ["folds", "validation", &number, &i.to_string()];
            if let Some(first) = seen.insert(name, f) {
                bad(
                    &key,
                    format!("trial `{name}` is in folds {first} and {f}"),
                    "a trial validates in one fold: delete one",
                );
            }
            let role = trials.iter().find(|t| t.name == *name).map(|t| t.role);
            if let Some(role) = role.filter(|r| matches!(r, Role::HeldOut | Role::Excluded)) {
                let what = format!("fold {f} names trial `{name}`, whose role is {}", role.name());
                bad(&key, what, "a fold validates on development or calibration trials: move or delete it");
            }
        }
    }
}

/// Trials of one sample; the parts of a cut that have none are told apart before.
pub(crate) fn recorded(trials: &[Trial], problems: &mut Vec<DataError>) {
    for trial in trials.iter().filter(|t| t.samples() == 1 || (t.samples() == 0 && !t.dropped.is_empty())) {
        problems.push(few(trial, trial.samples(), LEAST_SAMPLES, String::new(), ""));
    }
}

/// Trials that learn or are scored and have no stretch of `window` samples without a gap over `max_gap` seconds.
pub(crate) fn windows(trials: &[Trial], window: usize, max_gap: f64) -> Vec<DataError> {
    let used = trials.iter().filter(|t| matches!(t.role, Role::Development | Role::HeldOut));
    let mut problems = Vec::new();
    for trial in used.filter(|t| t.samples() >= LEAST_SAMPLES) {
        let samples = segments(&trial.time, max_gap).iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        if samples < window {
            let gap = format!(" without a gap over {max_gap} s");
            problems.push(few(trial, samples, window, gap, " of a window"));
        }
    }
    problems
}

fn few(trial: &Trial, samples: usize, needed: usize, gap: String, why: &'static str) -> DataError {
    DataError::FewSamples { file: trial.file.clone(), trial: trial.name.clone(), samples, needed, gap, why }
}
