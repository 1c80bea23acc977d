//! Parameters that were found against the true ones.
//!
//! The truth has formulas of its own, so a fitted value may differ from the true one by the truth's tolerance and be
//! right. An interval is held against the true value, against the band of tolerance around it, and against the value that the
//! library's formula takes on the same trials without noise: this is what an interval can promise.

use acm_sim::twin::undeclared::{Parameter, TrueEffect};
use acm_trace::finding::{FoundEffect, FoundParameter};
use serde::{Deserialize, Serialize};

use crate::scoring::answer::ends;

/// One true parameter with its estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterRow {
    /// Name in the effect library.
    pub effect: String,
    /// Name in the effect library.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// True value.
    pub truth: f64,
    /// A fitted value may differ by this much and be right.
    pub tolerance: f64,
    /// Estimated value.
    pub value: f64,
    /// Interval of 95 %.
    #[serde(deserialize_with = "ends")]
    pub interval: [f64; 2],
    /// Error |found − true| / tolerance.
    pub error: f64,
    /// Whether the true value lies within the interval.
    pub covered: bool,
    /// Whether some value within the tolerance lies within the interval.
    pub covered_within_tolerance: bool,
    /// Value that a search among the same effects finds without noise; none where it finds another set.
    pub without_noise: Option<f64>,
}

impl ParameterRow {
    /// Returns whether the value without noise lies within the interval; none without that value.
    pub fn covers_without_noise(&self) -> Option<bool> {
        let [low, high] = self.interval;
        self.without_noise.map(|value| (low..=high).contains(&value))
    }
}

/// Returns every true parameter of effects that were found by their own name.
pub fn parameters(truth: &[TrueEffect], found: &[FoundEffect]) -> Vec<ParameterRow> {
    let own = |effect: &TrueEffect| found.iter().find(|found| Some(&found.name) == effect.name.as_ref());
    let named = truth.iter().filter_map(|effect| Some((effect, own(effect)?)));
    named.flat_map(|(truth, found)| truth.parameters.iter().filter_map(|p| counterpart(p, found))).collect()
}

/// Returns the rows with the values of those that were found without noise.
pub fn with_values_without_noise(rows: Vec<ParameterRow>, found: &[ParameterRow]) -> Vec<ParameterRow> {
    let same = |row: &ParameterRow| found.iter().find(|one| (&one.effect, &one.name) == (&row.effect, &row.name));
    let with = |row: ParameterRow| ParameterRow { without_noise: same(&row).map(|one| one.value), ..row };
    rows.into_iter().map(with).collect()
}

fn counterpart(truth: &Parameter, effect: &FoundEffect) -> Option<ParameterRow> {
    let found = effect.parameters.iter().find(|p| p.name == truth.name && p.depends_on.is_none())?;
    Some(compared(truth, found, &effect.name))
}

fn compared(truth: &Parameter, found: &FoundParameter, effect: &str) -> ParameterRow {
    let [low, high] = found.interval;
    let (value, tolerance) = (truth.value, truth.tolerance);
    ParameterRow {
        effect: effect.into(),
        name: truth.name.clone(),
        unit: truth.unit.clone(),
        truth: value,
        tolerance,
        value: found.value,
        interval: found.interval,
        error: (found.value - value).abs() / tolerance.max(f64::MIN_POSITIVE),
        covered: (low..=high).contains(&value),
        covered_within_tolerance: low <= value + tolerance && value - tolerance <= high,
        without_noise: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic.
    #[test]
    fn a_value_beside_its_interval_and_within_the_tolerance() {
        let truth = Parameter::new("delay", 0.20, "s", 0.02);
        let found = |value: f64, interval| FoundParameter {
            name: "delay".into(),
            value,
            unit: "s".into(),
            interval,
            depends_on: None,
            at_bound: false,
            undetermined: false,
        };
        let row = compared(&truth, &found(0.23, [0.21, 0.25]), "dead_time");
        assert!((row.error - 1.5).abs() < 1e-12 && !row.covered && row.covered_within_tolerance);
        let row = compared(&truth, &found(0.19, [0.17, 0.21]), "dead_time");
        assert!(row.covered && row.covered_within_tolerance);
        let row = compared(&truth, &found(0.10, [0.08, 0.12]), "dead_time");
        assert!(!row.covered && !row.covered_within_tolerance);
    }

    /// Oracle: by hand. Without noise the first delay is found within its interval, the second is not found at all.
    #[test]
    fn an_interval_is_held_against_the_value_without_noise() {
        let row = |effect: &str, value: f64| ParameterRow {
            effect: effect.into(),
            name: "delay".into(),
            unit: "s".into(),
            truth: 0.20,
            tolerance: 0.02,
            value,
            interval: [0.21, 0.25],
            error: 1.5,
            covered: false,
            covered_within_tolerance: true,
            without_noise: None,
        };
        for (value, covers) in [(0.22, true), (0.20, false)] {
            let rows = vec![row("dead_time", 0.23), row("measurement_delay", 0.23)];
            let rows = with_values_without_noise(rows, &[row("dead_time", value)]);
            assert_eq!(rows.iter().map(ParameterRow::covers_without_noise).collect::<Vec<_>>(), [Some(covers), None]);
        }
    }
}
