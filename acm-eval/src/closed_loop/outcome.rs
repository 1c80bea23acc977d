//! Baselines and the result, as rows that figure, table and terminal share.

use acm_trace::finding::{Estimate, Finding};

use super::quantity::decimals;

/// Errors on held-out trials, ready to be shown.
#[derive(Debug, Clone)]
pub struct Outcome<'a> {
    /// Unit of all errors.
    pub unit: &'a str,
    /// White noise.
    pub noise: f64,
    /// Number of decimals that the interval of the result justifies.
    pub decimals: usize,
    /// Share of the removable error that was removed.
    pub removed: Option<f64>,
    /// Whether anything was added.
    pub found: bool,
    baselines: [Estimate; 3],
    after: Estimate,
    without_offsets: Option<Estimate>,
    best: Option<usize>,
}

/// One model.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Label in words.
    pub label: &'static str,
    /// Meaning of the row, in words.
    pub meaning: &'static str,
    /// Error on held-out trials.
    pub error: Estimate,
    /// Whether it is the best baseline, from which the share removed is counted.
    pub is_best_baseline: bool,
    /// Whether it includes the effects that were found.
    pub is_after: bool,
}

impl Row {
    /// Returns the label, marked where it is the best baseline.
    pub fn name(&self) -> String {
        if self.is_best_baseline { format!("{} (best baseline)", self.label) } else { self.label.into() }
    }
}

impl<'a> Outcome<'a> {
    /// Returns the outcome of a finding.
    pub fn of(finding: &'a Finding) -> Self {
        let errors = &finding.errors;
        let baselines = [errors.baselines.nominal, errors.baselines.static_map, errors.baselines.recalibrated];
        let numbers = baselines.iter().enumerate().filter(|(_, baseline)| baseline.value.is_finite());
        let best = numbers.min_by(|a, b| a.1.value.total_cmp(&b.1.value)).map(|(index, _)| index);
        Self {
            unit: &errors.unit,
            noise: errors.noise,
            decimals: decimals(errors.after.value, errors.after.interval).max(1),
            removed: finding.removed.filter(|share| share.is_finite()),
            found: finding.adds(),
            baselines,
            after: errors.after,
            without_offsets: errors.after_without_offsets,
            best,
        }
    }

    /// Returns the three baselines, then the result, then the result without offsets of trials.
    pub fn rows(&self) -> Vec<Row> {
        let row = |(label, meaning): (&'static str, &'static str), error: Estimate| Row {
            label,
            meaning,
            error,
            is_best_baseline: false,
            is_after: false,
        };
        let baselines = BASELINES.into_iter().zip(self.baselines).enumerate();
        let mut rows: Vec<Row> = baselines
            .map(|(index, (words, error))| Row { is_best_baseline: Some(index) == self.best, ..row(words, error) })
            .collect();
        rows.push(Row { is_after: true, ..row(if self.found { AFTER } else { NOTHING }, self.after) });
        rows.extend(self.without_offsets.map(|error| row(WITHOUT_OFFSETS, error)));
        rows
    }
}

/// Returns the name of the result in every figure: with effects, or nothing added.
pub fn after(finding: &Finding) -> &'static str {
    if finding.adds() { AFTER.0 } else { NOTHING.0 }
}

const BASELINES: [(&str, &str); 3] = [
    ("nominal", "the model as calibrated"),
    ("+ static map", "with a smooth map of its error, learned from calibration trials"),
    ("+ recalibrated", "with the map, and calibrated again on all but the held-out trials"),
];

const AFTER: (&str, &str) = ("with what was found", "with the effects below, each at its place in the model");
const NOTHING: (&str, &str) = ("nothing added", "no effect was found that belongs in the model");
const WITHOUT_OFFSETS: (&str, &str) =
    ("… offsets removed", "the same, with the mean error of each trial taken out: no model can know it beforehand");
