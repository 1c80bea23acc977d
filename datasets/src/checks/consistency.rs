//! Consistency of manifest and recordings: trials, roles, folds, conditions, lengths.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hasher};
use std::path::PathBuf;

use crate::entry::Entry;
use crate::error::{DataError, short};
use crate::manifest::{Manifest, Role};
use crate::toml_file::TomlSource;
use crate::trial::Trial;

/// Fewer samples are no recording.
const LEAST_SAMPLES: usize = 2;

/// Identity of a trial, before it is cut.
#[derive(Debug)]
pub(crate) struct Whole {
    pub name: String,
    file: PathBuf,
    samples: usize,
    /// Over all values, without the time.
    values: u64,
}

impl Whole {
    pub fn of(trial: &Trial) -> Self {
        let mut hash = DefaultHasher::new();
        for values in [&trial.measured, &trial.actuators, &trial.context] {
            // 0 and −0 are the same value
            values.iter().for_each(|value| hash.write_u64((value + 0.0).to_bits()));
        }
        let (name, file) = (trial.name.clone(), trial.file.clone());
        Self { name, file, samples: trial.samples(), values: hash.finish() }
    }
}

/// A trial's name is unique.
pub(crate) fn unique(trials: &[Whole], problems: &mut Vec<DataError>) {
    let mut names: BTreeMap<&str, &Whole> = BTreeMap::new();
    for trial in trials {
        if let Some(first) = names.insert(&trial.name, trial) {
            let (first, second) = (first.file.clone(), trial.file.clone());
            problems.push(DataError::TrialInTwoFiles { trial: trial.name.clone(), first, second });
        }
    }
}

/// A warning for each group of trials with the same values: copies, or a robot at rest. Excluded trials may be copies.
pub(crate) fn repeated(trials: &[Whole], entries: &[Entry]) -> Vec<String> {
    let roles: BTreeMap<&str, Role> = entries.iter().map(|entry| (entry.name.as_str(), entry.role)).collect();
    let role = |trial: &Whole| roles.get(trial.name.as_str()).copied();
    let mut groups: BTreeMap<(usize, u64), Vec<&Whole>> = BTreeMap::new();
    for trial in trials.iter().filter(|t| t.samples >= LEAST_SAMPLES && role(t) != Some(Role::Excluded)) {
        groups.entry((trial.samples, trial.values)).or_default().push(trial);
    }
    let mut groups: Vec<_> = groups.into_values().filter(|group| group.len() > 1).collect();
    groups.sort_by_key(|group| &group[0].name);
    let told = |group: Vec<&Whole>| {
        let names: Vec<String> = group.iter().map(|t| format!("`{}` ({})", t.name, t.file.display())).collect();
        let names = short(&names.join(" and "), 400);
        let held_out = group.iter().find(|t| role(t) == Some(Role::HeldOut));
        let learned = group.iter().find(|t| matches!(role(t), Some(Role::Development | Role::Calibration)));
        let leak = held_out.zip(learned).map_or(String::new(), |(held_out, learned)| {
            let (held_out, role, learned) = (&held_out.name, role(learned).map_or("", Role::name), &learned.name);
            format!(": held-out trial `{held_out}` repeats {role} trial `{learned}`, so its error tests nothing")
        });
        format!("trials {names} hold the same values{leak}; if one is a copy, delete it or exclude it in [roles]")
    };
    groups.into_iter().map(told).collect()
}

/// Roles, cuts, folds and conditions name trials that exist.
pub(crate) fn names(
    manifest: &Manifest,
    source: &TomlSource,
    left_out: Vec<&str>,
    wholes: &[Whole],
    trials: &[Entry],
    problems: &mut Vec<DataError>,
) {
    let read: Vec<&str> = wholes.iter().map(|whole| whole.name.as_str()).chain(left_out).collect();
    let parts: Vec<&str> = trials.iter().map(|t| t.name.as_str()).collect();
    let (is_read, is_part): (BTreeSet<&str>, BTreeSet<&str>) =
        (read.iter().copied().collect(), parts.iter().copied().collect());
    let (read, parts) = (short(&read.join(" "), 400), short(&parts.join(" "), 400));
    let mut unknown = |key: &[&str], section, trial: &str, known: &str| {
        let (trial, known) = (trial.to_string(), known.to_string());
        problems.push(DataError::UnknownTrial { at: source.place(key), section, trial, known });
    };
    for role in Role::ALL {
        for (i, name) in manifest.roles.of(role).iter().enumerate().filter(|(_, n)| !is_read.contains(n.as_str())) {
            unknown(&["roles", role.name(), &i.to_string()], "[roles]", name, &read);
        }
    }
    for name in manifest.cut.keys().filter(|n| !is_read.contains(n.as_str())) {
        unknown(&["cut", name], "[cut]", name, &read);
    }
    let nowhere = |name: &str| !is_read.contains(name) && !is_part.contains(name);
    for name in manifest.conditions.keys().filter(|n| nowhere(n)) {
        unknown(&["conditions", name], "[conditions]", name, &parts);
    }
    for (f, fold) in manifest.folds.validation.iter().enumerate() {
        for (i, name) in fold.iter().enumerate().filter(|(_, n)| !is_part.contains(n.as_str())) {
            unknown(&["folds", "validation", &f.to_string(), &i.to_string()], "[folds]", name, &parts);
        }
    }
}

/// Each fold has trials that the networks may learn from, and no trial is in two folds.
pub(crate) fn folds(manifest: &Manifest, source: &TomlSource, trials: &[Entry], problems: &mut Vec<DataError>) {
    let roles: BTreeMap<&str, Role> = trials.iter().map(|t| (t.name.as_str(), t.role)).collect();
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
            if let Some(role) = roles.get(name.as_str()).filter(|r| matches!(r, Role::HeldOut | Role::Excluded)) {
                let what = format!("fold {f} names trial `{name}`, whose role is {}", role.name());
                bad(&key, what, "a fold validates on development or calibration trials: move or delete it");
            }
        }
    }
}

/// Trials of one sample; parts of a cut without samples are reported earlier. Where a column names a trial for each row, the
/// rows are poses of one trial.
pub(crate) fn recorded(manifest: &Manifest, trials: &[Entry], problems: &mut Vec<DataError>) {
    let single = trials.iter().filter(|t| t.samples == 1).count();
    if let (Some(column), true) = (&manifest.table.trial.column, single > 1 && 2 * single > trials.len()) {
        let (path, column) = (trials[0].file.clone(), column.clone());
        return problems.push(DataError::TrialOfEachRow { path, column, single, trials: trials.len() });
    }
    for trial in trials.iter().filter(|t| t.samples == 1 || (t.samples == 0 && !t.dropped.is_empty())) {
        problems.push(few(trial, trial.samples, LEAST_SAMPLES, String::new(), ""));
    }
}

/// Trials that learn or are scored and have no stretch of `window` samples without a gap.
pub(crate) fn windows(trials: &[Entry], window: usize) -> Vec<DataError> {
    let used = trials.iter().filter(|t| matches!(t.role, Role::Development | Role::HeldOut));
    let short = used.filter(|t| t.samples >= LEAST_SAMPLES && t.longest < window);
    let gap = |trial: &Entry| format!(" without a gap over {} s", trial.max_gap);
    short.map(|trial| few(trial, trial.longest, window, gap(trial), " of a window")).collect()
}

fn few(trial: &Entry, samples: usize, needed: usize, gap: String, why: &'static str) -> DataError {
    DataError::FewSamples { file: trial.file.clone(), trial: trial.name.clone(), samples, needed, gap, why }
}
