//! Figures over small rigs: error of the loop on held-out trials, compared with that of a fit of the true structure.
//!
//! | figure | what |
//! | --- | --- |
//! | as good as the oracle | rigs whose error is at most 1.05 of the oracle's |
//! | ratio | error over the oracle's; quantiles |
//! | exact | rigs in which every cause whose absence shows is named, or an indistinguishable effect, and no name is wrong |
//! | exact and sure | the same of sure names |

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::several::Figures;
use crate::scoring::answer::{Answer, Names, is_named};
use crate::scoring::share::{Share, quantile};

/// Largest ratio of an error to the oracle's that counts as equal.
pub const AS_GOOD: f64 = 1.05;

/// One rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RigRow {
    /// Seed of the rig.
    pub seed: u64,
    /// Number of development trials: one record, or several.
    pub records: usize,
    /// Error of the loop on held-out trials, in the output's SI unit.
    pub error: f64,
    /// Best error without an effect, in the same unit.
    pub before: f64,
    /// Error of the oracle, in the same unit.
    pub oracle: f64,
    /// True noise, in the same unit.
    pub noise: f64,
    /// Computing time, s.
    pub seconds: f64,
    /// Claims and truth.
    pub answer: Answer,
}

impl RigRow {
    /// Returns the error over the oracle's.
    pub fn ratio(&self) -> f64 {
        self.error / self.oracle
    }
}

/// Figures of some rigs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RigFigures {
    /// Number of rigs.
    pub rigs: usize,
    /// Share of rigs on which the error is that of the oracle.
    pub as_good: Share,
    /// Quantiles of the ratio: 50, 75, 90, 100 %.
    pub ratio: [Option<f64>; 4],
    /// Answers whose names are exact.
    pub exact: Share,
    /// Answers whose sure names are exact.
    pub exact_and_sure: Share,
}

impl RigFigures {
    /// Returns the figures of the given rows.
    pub fn new(rows: &[&RigRow]) -> Self {
        let ratios: Vec<f64> = rows.iter().map(|row| row.ratio()).collect();
        Self {
            rigs: rows.len(),
            as_good: Share::of(&ratios, |ratio| **ratio <= AS_GOOD),
            ratio: [0.5, 0.75, 0.9, 1.0].map(|share| quantile(&ratios, share)),
            exact: Share::of(rows, |row| is_named(&row.answer)),
            exact_and_sure: Share::of(rows, |row| Names::new(&row.answer).is_exact()),
        }
    }
}

/// Figures of all rigs and of each kind, and how right the names are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RigScore {
    /// Figures of all rigs.
    pub all: RigFigures,
    /// Figures of rigs with one record, and of rigs with several.
    pub records: [RigFigures; 2],
    /// Figures of each kind.
    pub kinds: BTreeMap<String, RigFigures>,
    /// Names, shares and intervals of all.
    pub names: Figures,
}

impl RigScore {
    /// Returns the figures of all rigs that were tried.
    pub fn new(rows: &[RigRow]) -> Self {
        let mut kinds: BTreeMap<String, Vec<&RigRow>> = BTreeMap::new();
        rows.iter().for_each(|row| kinds.entry(row.answer.kind.clone()).or_default().push(row));
        let answers: Vec<Answer> = rows.iter().map(|row| row.answer.clone()).collect();
        Self {
            all: RigFigures::new(&rows.iter().collect::<Vec<_>>()),
            records: [true, false].map(|one| RigFigures::new(&records(rows, one))),
            kinds: kinds.into_iter().map(|(kind, rows)| (kind, RigFigures::new(&rows))).collect(),
            names: Figures::new(&answers),
        }
    }
}

fn records(rows: &[RigRow], one: bool) -> Vec<&RigRow> {
    rows.iter().filter(|row| (row.records == 1) == one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::answer::{answer, cause, claim};

    fn row(kind: &str, error: f64, named: &str) -> RigRow {
        let causes = vec![cause("inertia", Some("angle"), &[], true)];
        let claims = vec![claim(named, Some("angle"), true, 1.0)];
        RigRow {
            seed: 1,
            records: if error > 5.0 { 1 } else { 4 },
            error,
            before: 9.0,
            oracle: 2.0,
            noise: 1.9,
            seconds: 1.0,
            answer: answer(kind, causes, claims),
        }
    }

    /// Oracle: counted by hand. Ratios are 1.05, 1.06, 0.9 and 3.
    #[test]
    fn rigs_are_counted_by_hand() {
        let rows = [
            row("axis", 2.1, "inertia"),
            row("axis", 2.12, "inertia"),
            row("sheath", 1.8, "backlash"),
            row("sheath", 6.0, "inertia"),
        ];
        let score = RigScore::new(&rows);
        let share = |count, of| Share { count, of };
        assert_eq!((score.all.rigs, score.all.as_good, score.all.exact), (4, share(2, 4), share(3, 4)));
        assert_eq!((score.kinds["axis"].as_good, score.kinds["sheath"].exact), (share(1, 2), share(1, 2)));
        assert!((score.all.ratio[0].unwrap_or(0.0) - 1.055).abs() < 1e-9 && score.all.ratio[3] == Some(3.0));
        assert_eq!(score.records.each_ref().map(|figures| figures.as_good), [share(0, 1), share(2, 3)]);
        assert_eq!(score.names.precision, share(3, 4));
    }
}
