//! Before and after, as rows that figure, table and terminal share.

use acm_trace::finding::{Estimate, Finding};

use super::quantity::decimals;

/// Errors on untouched trials, ready to be shown.
#[derive(Debug, Clone)]
pub struct Outcome<'a> {
    /// Of all errors.
    pub unit: &'a str,
    /// White noise.
    pub floor: f64,
    /// Digits after the point that the last row's interval justifies.
    pub decimals: usize,
    /// Share of the removable error that is gone.
    pub removed: Option<f64>,
    /// Whether anything was added.
    pub found: bool,
    befores: [Estimate; 3],
    after: Estimate,
    best: Option<usize>,
}

/// One model.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// In words.
    pub label: &'static str,
    /// What was done, for a reader who meets the word for the first time.
    pub meaning: &'static str,
    /// On untouched trials.
    pub error: Estimate,
    /// Whether it is the smallest of the befores, from which the share removed is counted.
    pub is_best_before: bool,
    /// Whether it has the effect.
    pub is_after: bool,
}

impl<'a> Outcome<'a> {
    /// From a finding.
    pub fn of(finding: &'a Finding) -> Self {
        let errors = &finding.errors;
        let before = errors.before();
        let befores = [before.nominal, before.static_map, before.recalibrated];
        let after = errors.after();
        let numbers = befores.iter().enumerate().filter(|(_, before)| before.value.is_finite());
        let best = numbers.min_by(|a, b| a.1.value.total_cmp(&b.1.value)).map(|(index, _)| index);
        let (unit, floor) = (errors.unit(), errors.floor());
        let removed = finding.removed.filter(|share| share.is_finite());
        let decimals = decimals(after.value, after.interval).max(1);
        let found = !finding.effects.is_empty();
        Self { unit, floor, decimals, removed, befores, after, best, found }
    }

    /// The three befores, then after.
    pub fn rows(&self) -> Vec<Row> {
        let befores = BEFORES.iter().zip(&self.befores).enumerate().map(|(index, ((label, meaning), error))| Row {
            label,
            meaning,
            error: *error,
            is_best_before: Some(index) == self.best,
            is_after: false,
        });
        let (label, meaning) = if self.found { AFTER } else { NOTHING };
        befores.chain([Row { label, meaning, error: self.after, is_best_before: false, is_after: true }]).collect()
    }
}

/// What the last row is called in every figure: something was found, or nothing added.
pub fn after(finding: &Finding) -> &'static str {
    if finding.effects.is_empty() { NOTHING.0 } else { AFTER.0 }
}

const BEFORES: [(&str, &str); 3] = [
    ("nominal", "the model as calibrated"),
    ("+ static map", "with a smooth map of its error, learned from calibration trials"),
    ("+ recalibrated", "with the map, and calibrated again on all but the untouched trials"),
];

const AFTER: (&str, &str) = ("with what was found", "with the effects below, each at its place in the model");
const NOTHING: (&str, &str) = ("nothing added", "no effect was found that belongs in the model");
