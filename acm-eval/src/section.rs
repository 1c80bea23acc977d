//! Runs on the same data, side by side.
//!
//! Errors are compared only where the data (by hash) and the target time stamps are identical. Other data make another
//! section of the page; other time stamps are refused.

pub mod estimator;
pub mod targets;

use std::collections::BTreeMap;

use acm_train::run::evaluation::summary::display;
use acm_train::run::names::some;
use acm_train::run::record::{CalibrationPair, DataStamp, PartScores, RunRecord, Score};

use crate::error::EvalError;
use crate::run::Run;
use crate::run::predictions::Predictions;
use crate::section::estimator::{Estimator, estimators, suffixed};
use crate::section::targets::same_targets;
use crate::unit::{Display, total_name};

/// All runs on one data set.
#[derive(Debug)]
pub struct Section {
    /// The data, as the first run saw them.
    pub data: DataStamp,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Display of errors.
    pub display: Display,
    /// The runs, as given.
    pub runs: Vec<Run>,
    /// The rows of every table: baselines, then networks.
    pub estimators: Vec<Estimator>,
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
        let held_out = runs
            .iter()
            .flat_map(|run| &run.records)
            .map(|record| record.held_out.as_ref().unwrap_or(&record.validation));
        let display = display(&data.unit, held_out);
        let estimators = estimators(&runs);
        Ok(Self { data, outputs, display, runs, estimators })
    }

    /// Returns the name of the error over all outputs.
    pub fn total(&self) -> &'static str {
        total_name(&self.data.unit, self.outputs.len())
    }

    /// Scores on the held-out trials, one per seed.
    pub fn held_out<'a>(&'a self, estimator: &'a Estimator) -> impl Iterator<Item = &'a Score> {
        self.scores(estimator, |part| Some(&part.estimators)).map(|(_, score)| score)
    }

    /// Returns the name of the record and score of each seed on the held-out trials. `pick` chooses the scores of all
    /// trials, or of one.
    pub fn scores<'a>(
        &'a self,
        estimator: &'a Estimator,
        pick: impl Fn(&'a PartScores) -> Option<&'a BTreeMap<String, Score>> + 'a,
    ) -> impl Iterator<Item = (String, &'a Score)> {
        let finals = self.runs[estimator.run].finals();
        finals.filter_map(move |(record, _)| {
            Some((record.id.clone(), pick(record.held_out.as_ref()?)?.get(&estimator.key)?))
        })
    }

    /// Returns the percentage by which each seed's error over all outputs is below that of the run's own nominal model,
    /// with the name of its record. `pick` as in [`Section::scores`].
    pub fn improvements<'a>(
        &'a self,
        estimator: &'a Estimator,
        pick: impl Fn(&'a PartScores) -> Option<&'a BTreeMap<String, Score>>,
    ) -> Vec<(String, f64)> {
        let finals = self.runs[estimator.run].finals();
        let gains = finals.filter_map(|(record, _)| {
            let scores = pick(record.held_out.as_ref()?)?;
            let (nominal, own) = (scores.get("nominal")?, scores.get(&estimator.key)?);
            Some((record.id.clone(), 100.0 * (1.0 - own.rmse_total / nominal.rmse_total)))
        });
        gains.collect()
    }

    /// Returns the names of the held-out trials.
    pub fn held_out_trials(&self) -> Vec<&str> {
        let first = self.runs.iter().find_map(|run| run.held_out().next());
        let mut trials: Vec<&str> = first.map_or(vec![], |part| part.trials.keys().map(String::as_str).collect());
        trials.sort_by_key(|trial| natural(trial));
        trials
    }

    /// Returns the network rows.
    pub fn networks(&self) -> impl Iterator<Item = &Estimator> {
        self.estimators.iter().filter(|estimator| estimator.network)
    }

    /// Returns the final record of a network whose held-out error is the median of its seeds (the lower one of two).
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

/// Returns every distinct calibration with its trials, as `trials 17, 18`, and the run where runs differ.
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
        suffixed(&format!("{group}trials {}", some(&pair.trials, ", ")), several, run)
    };
    distinct
        .iter()
        .flat_map(|run| run.nominal.calibrations.iter().map(move |(group, pair)| (label(run, group, pair), pair)))
        .collect()
}

/// Returns whether the calibrations are equal. They keep every bit of their numbers as JSON, so equal text is equal
/// calibration.
fn alike(a: &Run, b: &Run) -> bool {
    let text = |run: &Run| serde_json::to_string(&run.nominal.calibrations).ok();
    text(a) == text(b)
}

/// Returns a sort key that puts trial 9 before trial 10.
pub fn natural(name: &str) -> (u64, String) {
    let digits: String = name.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
    (digits.parse().unwrap_or(u64::MAX), name.to_string())
}
