//! Estimators of the tip: the rows of every table, and the colours of every figure.

use acm_train::run::record::{NominalSource, PartScores, Stage};

use crate::figures::canvas::palette;
use crate::run::Run;
use crate::spread::Spread;

/// One row of a table: an estimator of the tip.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimator {
    /// Label on the page.
    pub label: String,
    /// Key in the scores.
    pub key: String,
    /// Whether it is a network. Baselines do not depend on the seed.
    pub network: bool,
    /// The run it is read from, an index into [`runs`](crate::section::Section::runs).
    pub run: usize,
    /// Colour in every figure, `#rrggbb`.
    pub colour: &'static str,
}

impl Estimator {
    /// Returns the mean and spread over seeds; a baseline's values do not depend on the seed, so equal ones have no
    /// spread.
    pub fn spread(&self, values: &[f64]) -> Option<Spread> {
        if self.network { Spread::of(values) } else { Spread::of_constant(values) }
    }
}

/// Returns the baselines once per distinct set of scores, then one row per run's network.
pub fn estimators(runs: &[Run]) -> Vec<Estimator> {
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
        let key = run.kind();
        let shared = runs.iter().filter(|other| other.kind() == key).count() > 1;
        let label = suffixed(learned(&key), shared, run);
        let colour = colours.next(&key);
        rows.push(Estimator { label, key, network: true, run: index, colour });
    }
    rows
}

/// Returns `label`, with the run's name where `label` alone is ambiguous.
pub fn suffixed(label: &str, ambiguous: bool, run: &Run) -> String {
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

/// Returns the label of a network or an outside baseline.
fn learned(kind: &str) -> &str {
    match kind {
        "mlp" => "MLP",
        "gru" => "GRU",
        "cfc" => "CfC",
        "ridge" => "Ridge on lagged inputs",
        "boosted_trees" => "Boosted trees",
        other => other,
    }
}

fn parts(run: &Run) -> impl Iterator<Item = (Stage, &PartScores)> {
    run.records.iter().map(|record| (record.stage, record.held_out.as_ref().unwrap_or(&record.validation)))
}

fn has(run: &Run, key: &str) -> bool {
    parts(run).any(|(_, part)| part.estimators.contains_key(key))
}

/// Returns whether two runs have equal scores of a baseline wherever both have the same stage.
fn same_scores(a: &Run, b: &Run, key: &str) -> bool {
    parts(a).all(|(stage, part)| {
        parts(b)
            .filter(|(other, _)| *other == stage)
            .all(|(_, other)| other.estimators.get(key) == part.estimators.get(key))
    })
}
