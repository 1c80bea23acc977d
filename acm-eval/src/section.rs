//! Runs on the same data, side by side.
//!
//! Errors are compared only where the data (by hash) and the target time stamps are identical. Other data make another
//! section of the page; other time stamps are refused.

use std::path::Path;

use acm_train::record::{CalibrationPair, DataStamp, NominalSource, PartScores, RunRecord, Score, Stage};

use crate::{
    error::EvalError,
    figures::palette,
    predictions::{HELD_OUT, Predictions, VALIDATION},
    run::Run,
    unit::Display,
};

/// All runs on one data set.
#[derive(Debug)]
pub struct Section {
    /// The data, as the first run saw them.
    pub data: DataStamp,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// How errors are shown.
    pub display: Display,
    /// The runs, as given.
    pub runs: Vec<Run>,
    /// The rows of every table: baselines, then networks.
    pub estimators: Vec<Estimator>,
}

/// One row of a table: who says where the tip is.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimator {
    /// What it is called on the page.
    pub label: String,
    /// What it is called in the scores.
    pub key: String,
    /// Baselines do not depend on the seed.
    pub network: bool,
    /// The run it is read from, an index into [`Section::runs`].
    pub run: usize,
    /// Colour in every figure, `#rrggbb`.
    pub colour: &'static str,
}

/// Groups runs by data, in the order in which the data first appear.
///
/// # Errors
/// Two runs on the same data were scored at different target time stamps.
pub fn sections(runs: Vec<Run>) -> Result<Vec<Section>, EvalError> {
    let mut groups: Vec<Vec<Run>> = Vec::new();
    for run in runs {
        let hash = &run.records[0].data.hash;
        match groups.iter_mut().find(|group| &group[0].records[0].data.hash == hash) {
            Some(group) => group.push(run),
            None => groups.push(vec![run]),
        }
    }
    groups.into_iter().map(Section::of).collect()
}

impl Section {
    fn of(runs: Vec<Run>) -> Result<Self, EvalError> {
        same_targets(&runs)?;
        let first = &runs[0].records[0];
        let (data, outputs) = (first.data.clone(), first.outputs.clone());
        let display = Display::of(&data.unit);
        let estimators = estimators(&runs);
        Ok(Self { data, outputs, display, runs, estimators })
    }

    /// Scores on the held-out trials, one per seed.
    pub fn held_out<'a>(&'a self, estimator: &'a Estimator) -> impl Iterator<Item = &'a Score> {
        self.runs[estimator.run].held_out().filter_map(|part| part.estimators.get(&estimator.key))
    }

    /// Scores on one held-out trial, one per seed.
    pub fn on_trial<'a>(&'a self, estimator: &'a Estimator, trial: &'a str) -> impl Iterator<Item = &'a Score> {
        self.runs[estimator.run].held_out().filter_map(|part| part.trials.get(trial)?.get(&estimator.key))
    }

    /// Names of the held-out trials.
    pub fn held_out_trials(&self) -> Vec<&str> {
        let first = self.runs.iter().find_map(|run| run.held_out().next());
        let mut trials: Vec<&str> = first.map_or(vec![], |part| part.trials.keys().map(String::as_str).collect());
        trials.sort_by_key(|trial| natural(trial));
        trials
    }

    /// The network rows.
    pub fn networks(&self) -> impl Iterator<Item = &Estimator> {
        self.estimators.iter().filter(|estimator| estimator.network)
    }

    /// The final record of a network whose held-out error is the median of its seeds (the lower one of two).
    pub fn median_seed(&self, estimator: &Estimator) -> Option<(&RunRecord, &Predictions)> {
        let error = |record: &RunRecord| Some(record.held_out.as_ref()?.estimators.get(&estimator.key)?.rmse_total);
        let mut finals: Vec<_> = self.runs[estimator.run]
            .finals()
            .filter_map(|(record, table)| Some((error(record)?, record, table)))
            .collect();
        finals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let median = finals.len().checked_sub(1)? / 2;
        finals.get(median).map(|&(_, record, table)| (record, table))
    }
}

/// Every distinct calibration with what it was made on, as `trials 17, 18`, and the run where runs differ.
pub fn calibrations(section: &Section) -> Vec<(String, &CalibrationPair)> {
    let mut distinct: Vec<&Run> = Vec::new();
    for run in &section.runs {
        if !distinct.iter().any(|other| alike(other, run)) {
            distinct.push(run);
        }
    }
    let several = distinct.len() > 1;
    let label = |run: &Run, group: &str, pair: &CalibrationPair| {
        let group = if group == "calibration" { String::new() } else { format!("{group}: ") };
        suffixed(&format!("{group}trials {}", pair.trials.join(", ")), several, run)
    };
    distinct
        .iter()
        .flat_map(|run| run.nominal.calibrations.iter().map(move |(group, pair)| (label(run, group, pair), pair)))
        .collect()
}

/// Calibrations keep every bit of their numbers as JSON, so equal text is equal calibration.
fn alike(a: &Run, b: &Run) -> bool {
    let text = |run: &Run| serde_json::to_string(&run.nominal.calibrations).ok();
    text(a) == text(b)
}

/// Sort key that puts trial 9 before trial 10.
pub fn natural(name: &str) -> (u64, String) {
    let digits: String = name.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
    (digits.parse().unwrap_or(u64::MAX), name.to_string())
}

/// Baselines once per distinct set of scores, then one row per run's network.
fn estimators(runs: &[Run]) -> Vec<Estimator> {
    let mut rows = Vec::new();
    for key in ["nominal", "polynomial"] {
        let mut distinct: Vec<usize> = Vec::new();
        for index in (0..runs.len()).filter(|&index| has(&runs[index], key)) {
            if !distinct.iter().any(|&other| same_scores(&runs[other], &runs[index], key)) {
                distinct.push(index);
            }
        }
        for &run in &distinct {
            let label = suffixed(baseline(&runs[run], key), distinct.len() > 1, &runs[run]);
            rows.push(Estimator { label, key: key.into(), network: false, run, colour: palette::baseline(key) });
        }
    }
    let mut colours = palette::Networks::default();
    for (index, run) in runs.iter().enumerate() {
        let shared = runs.iter().filter(|other| other.kind() == run.kind()).count() > 1;
        let label = suffixed(network(run.kind()), shared, run);
        let colour = colours.next(run.kind());
        rows.push(Estimator { label, key: run.kind().into(), network: true, run: index, colour });
    }
    rows
}

fn suffixed(label: &str, ambiguous: bool, run: &Run) -> String {
    if ambiguous { format!("{label} ({})", run.name) } else { label.to_string() }
}

fn baseline(run: &Run, key: &str) -> &'static str {
    match (key, run.nominal.source) {
        ("polynomial", _) => "Polynomial",
        (_, NominalSource::Predicted) => "Data's own prediction",
        (_, NominalSource::None) => "Zero (no nominal model)",
        _ => "Nominal",
    }
}

fn network(kind: &str) -> &str {
    match kind {
        "mlp" => "MLP",
        "gru" => "GRU",
        "cfc" => "CfC",
        other => other,
    }
}

fn parts(run: &Run) -> impl Iterator<Item = (Stage, &PartScores)> {
    run.records.iter().map(|record| (record.stage, record.held_out.as_ref().unwrap_or(&record.validation)))
}

fn has(run: &Run, key: &str) -> bool {
    parts(run).any(|(_, part)| part.estimators.contains_key(key))
}

/// Whether two runs score a baseline alike wherever both have the same stage.
fn same_scores(a: &Run, b: &Run, key: &str) -> bool {
    parts(a).all(|(stage, part)| {
        parts(b)
            .filter(|(other, _)| *other == stage)
            .all(|(_, other)| other.estimators.get(key) == part.estimators.get(key))
    })
}

/// All records of one stage, in all runs, score the same trials at the same times.
fn same_targets(runs: &[Run]) -> Result<(), EvalError> {
    let mut seen: Vec<(Stage, &str, &Path, &Predictions)> = Vec::new();
    for run in runs {
        for (record, table) in run.records.iter().zip(&run.predictions) {
            let part = if record.stage == Stage::Final { HELD_OUT } else { VALIDATION };
            let known = seen.iter().find(|(stage, ..)| *stage == record.stage);
            match known {
                None => seen.push((record.stage, part, &run.folder, table)),
                Some((_, _, folder, other)) => {
                    if let Some(difference) = difference(other, table, part) {
                        let (first, second) = (folder.to_path_buf(), run.folder.clone());
                        return Err(EvalError::Incomparable { first, second, difference });
                    }
                }
            }
        }
    }
    Ok(())
}

/// The first place where two tables have different targets.
fn difference(a: &Predictions, b: &Predictions, part: &str) -> Option<String> {
    let (left, right) = (a.trials(part), b.trials(part));
    let names =
        |trials: &[crate::predictions::TrialRows]| trials.iter().map(|rows| rows.trial).collect::<Vec<_>>().join(", ");
    let (ours, theirs) = (names(&left), names(&right));
    if ours != theirs {
        return Some(format!("the {part} trials of the first are [{ours}], of the second [{theirs}]"));
    }
    left.iter().zip(&right).find_map(|(l, r)| {
        let (l_times, r_times) = (&a.time()[l.rows.clone()], &b.time()[r.rows.clone()]);
        let trial = l.trial;
        let place = l_times.iter().zip(r_times).position(|(x, y)| x != y);
        match place {
            Some(row) => Some(format!(
                "in {part} trial {trial}, target {} is at {} s in the first and at {} s in the second",
                row + 1,
                l_times[row],
                r_times[row]
            )),
            None if l_times.len() != r_times.len() => Some(format!(
                "{part} trial {trial} has {} targets in the first and {} in the second",
                l_times.len(),
                r_times.len()
            )),
            None => None,
        }
    })
}
