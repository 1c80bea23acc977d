//! Figures over campaigns of several causes: how right the sure names are, how much is found, and whether shares and
//! intervals mean what they say.
//!
//! | figure | what |
//! | --- | --- |
//! | precision | sure names that stand for a cause, of all sure names |
//! | recall | separable causes that a sure name stands for, of all separable causes |
//! | shown | causes whose absence shows that a sure name stands for, the true one or one that is as right |
//! | F1 of names | of each campaign, 2·TP/(2·TP + FP + FN); mean |
//! | F | share of the removable error that is gone, of each campaign; quantiles. Not removable is what no recording tells |
//! | reliability | of claims whose share lies in a bin, those that are right, beside their mean share |
//! | doubts | of claims that are chosen again nearly always and not sure, those that are right, by the reason |
//! | coverage | intervals that hold the true value, or come within the truth's tolerance |
//! | width | of an interval over the narrowest honest one; median |

use std::collections::BTreeMap;

use acm_sim::twin::undeclared::Design;
use acm_trace::finding::{Doubt, Verdict};
use serde::{Deserialize, Serialize};

use super::reliability::{Bin, doubted, reliability};
use crate::scoring::answer::{Answer, Interval, Names, is_named};
use crate::scoring::share::{Share, mean, quantile};

/// One campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeveralRow {
    /// Seed of the campaign.
    pub seed: u64,
    /// Motion of actuators and vehicle.
    pub design: Design,
    /// Number of trials.
    pub trials: usize,
    /// Smallest error on held-out trials without an effect, mm.
    pub before: f64,
    /// Error with the effects that were found, mm.
    pub after: f64,
    /// Noise and offsets of trials that no recording explains, mm.
    pub noise: f64,
    /// Verdict.
    pub verdict: Verdict,
    /// Computing time, s.
    pub seconds: f64,
    /// Claims and truth.
    pub answer: Answer,
}

/// Figures of some answers; see above for their definitions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Campaigns or rigs.
    pub answers: usize,
    /// Sure names that are right.
    pub precision: Share,
    /// Separable causes that are found with a sure name.
    pub recall: Share,
    /// Causes whose absence shows that are found with a sure name, their own or an indistinguishable effect.
    pub shown: Share,
    /// Mean F1 of the names.
    pub f1: Option<f64>,
    /// Number of sure names that are wrong.
    pub sure_wrong: usize,
    /// Answers in which every cause whose absence shows has a name, and no name is wrong.
    pub exact: Share,
    /// Answers in which every cause whose absence shows has a sure name, and no sure name is wrong.
    pub exact_and_sure: Share,
    /// Share of answers with a wrong name that is sure, by kind of campaign.
    pub false_names: BTreeMap<String, Share>,
    /// Quantiles of F: 0, 5, 10, 25, 50 %.
    pub removed: [Option<f64>; 5],
    /// Answers with an F of at least 0.95.
    pub removed_almost_all: Share,
    /// Bins of reliability.
    pub reliability: Vec<Bin>,
    /// Claims that are chosen again in 95 % of resamples and not sure: those that are right, by the reason.
    pub doubted: BTreeMap<Doubt, Share>,
    /// Intervals that hold the true value.
    pub covered: Share,
    /// Intervals that hold the true value, of answers whose names are exact.
    pub covered_where_exact: Share,
    /// Intervals that come within the truth's tolerance of it.
    pub covered_within_tolerance: Share,
    /// Median ratio of width to the ideal one.
    pub width: Option<f64>,
    /// Share with an error on held-out trials no larger than that of the best baseline.
    pub not_worse: Share,
    /// Share with an error within one per cent of the nominal one.
    pub hardly_worse: Share,
}

impl Figures {
    /// Returns the figures of the given answers.
    pub fn new(answers: &[Answer]) -> Self {
        let names: Vec<Names> = answers.iter().map(Names::new).collect();
        let sum = |of: fn(&Names) -> usize| names.iter().map(of).sum::<usize>();
        let (sure, wrong) = (sum(|names| names.sure), sum(|names| names.wrong.len()));
        let removed: Vec<f64> = answers.iter().filter_map(|answer| answer.removed).collect();
        let over_best: Vec<f64> = answers.iter().filter_map(|answer| answer.over_best).collect();
        let intervals = || answers.iter().flat_map(|answer| &answer.intervals);
        let exact = answers.iter().filter(|answer| is_named(answer));
        let covers = |one: &Interval| (one.interval[0]..=one.interval[1]).contains(&one.truth);
        Self {
            answers: answers.len(),
            precision: Share { count: sure - wrong, of: sure },
            recall: Share { count: sum(|names| names.found), of: sum(|names| names.separable) },
            shown: Share { count: sum(|names| names.shown_found), of: sum(|names| names.shown) },
            f1: mean(&names.iter().map(Names::f1).collect::<Vec<f64>>()),
            sure_wrong: wrong,
            exact: Share::of(answers, |answer| is_named(answer)),
            exact_and_sure: Share::of(&names, |names| names.is_exact()),
            false_names: false_names(answers, &names),
            removed: [0.0, 0.05, 0.1, 0.25, 0.5].map(|share| quantile(&removed, share)),
            removed_almost_all: Share::of(&removed, |share| **share >= 0.95),
            reliability: reliability(answers),
            doubted: doubted(answers),
            covered: Share::of(intervals(), |one| covers(one)),
            covered_where_exact: Share::of(exact.flat_map(|answer| &answer.intervals), |one| covers(one)),
            covered_within_tolerance: Share::of(intervals(), |one| {
                one.interval[0] <= one.truth + one.tolerance && one.truth - one.tolerance <= one.interval[1]
            }),
            width: width(answers),
            not_worse: Share::of(&over_best, |ratio| **ratio <= 1.0),
            hardly_worse: Share::of(&over_best, |ratio| **ratio <= 1.01),
        }
    }
}

/// Returns the share of answers with a wrong name that is sure, by kind of campaign.
fn false_names(answers: &[Answer], names: &[Names]) -> BTreeMap<String, Share> {
    let mut kinds: BTreeMap<String, Share> = BTreeMap::new();
    for (answer, names) in answers.iter().zip(names) {
        let share = kinds.entry(answer.kind.clone()).or_default();
        share.count += usize::from(!names.wrong.is_empty());
        share.of += 1;
    }
    kinds
}

/// Returns the median of width over the ideal one, where that is known.
fn width(answers: &[Answer]) -> Option<f64> {
    let intervals = answers.iter().flat_map(|answer| &answer.intervals);
    let ratio = |one: &Interval| Some((one.interval[1] - one.interval[0]) / one.ideal?);
    quantile(&intervals.filter_map(ratio).filter(|ratio| !ratio.is_nan()).collect::<Vec<f64>>(), 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::answer::{answer, cause, claim};

    fn share(count: usize, of: usize) -> Share {
        Share { count, of }
    }

    fn answers() -> Vec<Answer> {
        let interval =
            |low: f64, high: f64, ideal| Interval { truth: 1.0, tolerance: 0.1, interval: [low, high], ideal };
        let mut one = answer(
            "several3",
            vec![cause("creep", None, &[], true), cause("backlash", None, &[], true), cause("scale", None, &[], false)],
            vec![
                claim("creep", None, true, 0.99),
                claim("coupling", None, true, 0.95),
                claim("backlash", None, false, 0.8),
            ],
        );
        one.removed = Some(0.97);
        one.intervals = vec![interval(0.8, 1.2, Some(0.2)), interval(1.05, 1.15, Some(0.1))];
        let mut two = answer(
            "several2",
            vec![cause("dead_time", None, &[], true), cause("tip_load", None, &["self_weight"], true)],
            vec![
                claim("dead_time", None, true, 1.0),
                claim("self_weight", None, true, 0.96),
                claim("twist", None, false, 0.2),
            ],
        );
        two.removed = Some(0.5);
        two.intervals = vec![interval(1.2, 1.3, None), interval(0.0, f64::INFINITY, Some(0.1))];
        vec![one, two, answer("white", vec![], vec![])]
    }

    /// Oracle: counted by hand.
    #[test]
    fn names_are_counted_by_hand() {
        let figures = Figures::new(&answers());
        assert_eq!((figures.precision, figures.recall), (share(3, 4), share(2, 3)));
        // A name that is not sure and wrong spoils the second answer.
        assert_eq!((figures.exact, figures.exact_and_sure), (share(1, 3), share(2, 3)));
        assert_eq!((figures.sure_wrong, figures.shown), (1, share(3, 4)));
        // TP 1, FP 1, FN 1; TP 1; nothing.
        assert!((figures.f1.unwrap_or(0.0) - (0.5 + 1.0 + 1.0) / 3.0).abs() < 1e-12);
        let kinds: Vec<(&str, Share)> =
            figures.false_names.iter().map(|(kind, share)| (kind.as_str(), *share)).collect();
        assert_eq!(kinds, [("several2", share(0, 1)), ("several3", share(1, 1)), ("white", share(0, 1))]);
        assert_eq!((figures.removed[0], figures.removed[4]), (Some(0.5), Some(0.735)));
        assert_eq!(figures.removed_almost_all, share(1, 2));
    }

    /// Oracle: counted by hand. A share of one is in the last bin, one on an edge in the bin that begins there.
    #[test]
    fn shares_are_held_against_what_is_right() {
        let bins = Figures::new(&answers()).reliability;
        let rights: Vec<Share> = bins.iter().map(|bin| bin.right).collect();
        assert_eq!(rights, [share(0, 1), share(0, 0), share(1, 1), share(0, 0), share(3, 4)]);
        assert!(
            (bins[4].mean.unwrap_or(0.0) - (0.99 + 0.95 + 1.0 + 0.96) / 4.0).abs() < 1e-12 && bins[1].mean.is_none()
        );
    }

    /// Oracle: counted by hand; widths over the ideal ones are 2, 1 and infinite.
    #[test]
    fn intervals_are_counted_by_hand() {
        let figures = Figures::new(&answers());
        assert_eq!((figures.covered, figures.covered_within_tolerance), (share(2, 4), share(3, 4)));
        let mut without = answers();
        without[1].claims.pop();
        assert_eq!([figures, Figures::new(&without)].map(|one| one.covered_where_exact), [share(0, 0), share(1, 2)]);
        let figures = Figures::new(&answers());
        assert!((figures.width.unwrap_or(0.0) - 2.0).abs() < 1e-9, "{:?}", figures.width);
        assert_eq!(Figures::new(&[]).precision, share(0, 0));
    }
}
