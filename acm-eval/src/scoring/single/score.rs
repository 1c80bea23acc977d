//! Figures over many campaigns.

use acm_sim::twin::undeclared::{Class, Design};
use acm_trace::finding::Verdict;
use serde::Serialize;

use super::parameters::ParameterRow;
use super::row::{Row, Top};
use crate::scoring::aliases::LEVELS;
use crate::scoring::share::{Share, quantile};

/// Share of the removable error from which a removal counts as complete.
const ALMOST_ALL: f64 = 0.95;

/// Number of nulls that are reported separately.
const FIRST: usize = 200;

/// All campaigns, and their summary.
#[derive(Debug, Clone, Serialize)]
pub struct Score {
    /// Version of this layout.
    pub format: u32,
    /// Version of this program.
    pub version: String,
    /// Configuration of the search: samples, largest number of effects, seed.
    pub configuration: serde_json::Value,
    /// Summary of each design that was tried.
    pub designs: Vec<(Design, Summary)>,
    /// Summary of all campaigns.
    pub all: Summary,
    /// Rows, one for each campaign.
    pub rows: Vec<Row>,
}

/// Summary of some campaigns; see the page above for the definitions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Number of campaigns.
    pub campaigns: usize,
    /// The first name is the true one.
    pub top_by_name: Share,
    /// The first name is the true one, or one that the data cannot distinguish from it.
    pub top: Share,
    /// Share named first, counting aliases from a mutual share of 0.95, 0.98 and 0.99 on.
    pub top_at: [Share; 3],
    /// Share of campaigns in which the true name is in the set.
    pub in_set_by_name: Share,
    /// Share of campaigns in which a name of the set is the true one or indistinguishable from it.
    pub in_set: Share,
    /// Number of names that explain as much as the first, where anything was found.
    pub set_size: Option<f64>,
    /// Share of campaigns with two effects in which both were found.
    pub pairs_both: Share,
    /// Share of campaigns with two effects in which at least one was found.
    pub pairs_one: Share,
    /// Share of campaigns without a mechanism in which something is named and sure.
    pub false_names: Share,
    /// Share of campaigns without a mechanism in which an effect is found, and not sure.
    pub spurious_partials: Share,
    /// Share of campaigns without a mechanism in which the answer is "no effect".
    pub nulls_clean: Share,
    /// Share of campaigns without a mechanism in which anything is named, sure or not.
    pub any_name: Share,
    /// Share among the first 200 campaigns without a mechanism in which anything is named.
    pub any_name_first: Share,
    /// Share of campaigns outside of the library in which no name is sure.
    pub outside_abstained: Share,
    /// Share of campaigns outside of the library in which a sure name stands for no cause.
    pub outside_wrong: Share,
    /// Share of campaigns searched without the true effect in which no name is sure.
    pub without_own_abstained: Share,
    /// Share of campaigns searched without the true effect in which another cause has a sure name.
    pub without_own_wrong: Share,
    /// Share with an error on held-out trials no larger than the best baseline's.
    pub not_worse: Share,
    /// Share with an error on held-out trials at most one per cent above the best baseline's.
    pub hardly_worse: Share,
    /// Error on held-out trials over the best baseline's: worst.
    pub worst: Option<f64>,
    /// Share with F of at least 0.95.
    pub removed_almost_all: Share,
    /// Quantiles of F: 0, 5, 10, 25, 50 %.
    pub removed: [Option<f64>; 5],
    /// Share with F of at least 0.95 over the true noise.
    pub removed_almost_all_over_true_floor: Share,
    /// Quantiles of F over the true noise: 0, 5, 10, 25, 50 %.
    pub removed_over_true_floor: [Option<f64>; 5],
    /// Parameters within the tolerance of the truth.
    pub within_tolerance: Share,
    /// Quantiles of |error| / tolerance: 50, 90 %.
    pub parameter_error: [Option<f64>; 2],
    /// Intervals that cover the true value.
    pub covered: Share,
    /// Intervals that cover the value that is found without noise.
    pub covered_without_noise: Share,
    /// Intervals that reach the band of tolerance around it.
    pub covered_within_tolerance: Share,
    /// Computing time, s: median and longest.
    pub seconds: [Option<f64>; 2],
}

impl Score {
    /// Returns the score of all campaigns that were tried.
    pub fn new(rows: Vec<Row>, configuration: serde_json::Value) -> Self {
        let of = |design: Design| rows.iter().filter(|row| row.design == design).collect::<Vec<&Row>>();
        let tried = Design::ALL.into_iter().rev().map(|design| (design, of(design)));
        let designs = tried.filter(|(_, rows)| !rows.is_empty()).map(|(d, rows)| (d, Summary::new(&rows))).collect();
        let all = Summary::new(&rows.iter().collect::<Vec<&Row>>());
        Self { format: 1, version: env!("CARGO_PKG_VERSION").into(), configuration, designs, all, rows }
    }
}

impl Summary {
    /// Summarises the given rows.
    pub fn new(rows: &[&Row]) -> Self {
        let with_own = || rows.iter().filter(|row| !row.without_own);
        let known = || with_own().filter(|row| row.is_known());
        let of = |class: Class| with_own().filter(move |row| row.class == class);
        let bare = || rows.iter().filter(|row| row.without_own);
        let is_right = |row: &&&Row| matches!(row.top, Top::Name | Top::Alias);
        let removed: Vec<f64> = known().filter_map(|row| row.removed).collect();
        let over_true: Vec<f64> = known().filter_map(|row| row.removed_over_true_floor).collect();
        let quantiles = |values: &[f64]| [0.0, 0.05, 0.1, 0.25, 0.5].map(|share| quantile(values, share));
        let parameters = || known().flat_map(|row| &row.parameters);
        let errors: Vec<f64> = parameters().map(|parameter| parameter.error).collect();
        let over_best: Vec<f64> = rows.iter().filter_map(|row| row.answer.over_best).collect();
        let seconds: Vec<f64> = rows.iter().map(|row| row.seconds).collect();
        let sizes: Vec<f64> =
            known().filter(|row| !row.found.is_empty()).map(|row| row.equivalent.len() as f64).collect();
        Self {
            campaigns: rows.len(),
            top_by_name: Share::of(known(), |row| row.top == Top::Name),
            top: Share::of(known(), is_right),
            top_at: LEVELS.map(|level| Share::of(known(), |row| row.top == Top::Name || row.top_share >= level)),
            in_set_by_name: Share::of(known(), |row| row.in_set_by_name > 0),
            in_set: Share::of(known(), |row| row.in_set > 0),
            set_size: (!sizes.is_empty()).then(|| sizes.iter().sum::<f64>() / sizes.len() as f64),
            pairs_both: Share::of(of(Class::Pair), |row| row.right == 2),
            pairs_one: Share::of(of(Class::Pair), |row| row.right > 0),
            false_names: Share::of(of(Class::Null), |row| row.names()),
            spurious_partials: Share::of(of(Class::Null), |row| !row.names() && !row.found.is_empty()),
            any_name: Share::of(of(Class::Null), |row| !row.found.is_empty()),
            any_name_first: Share::of(of(Class::Null).take(FIRST), |row| !row.found.is_empty()),
            nulls_clean: Share::of(of(Class::Null), |row| row.verdict == Verdict::NoEffect),
            outside_abstained: Share::of(of(Class::Outside), |row| !row.names()),
            outside_wrong: Share::of(of(Class::Outside), |row| row.names_wrong()),
            without_own_abstained: Share::of(bare(), |row| !row.names()),
            without_own_wrong: Share::of(bare(), |row| row.names_wrong()),
            not_worse: Share::of(&over_best, |ratio| **ratio <= 1.0),
            hardly_worse: Share::of(&over_best, |ratio| **ratio <= 1.01),
            worst: quantile(&over_best, 1.0),
            removed_almost_all: Share::of(&removed, |share| **share >= ALMOST_ALL),
            removed: quantiles(&removed),
            removed_almost_all_over_true_floor: Share::of(&over_true, |share| **share >= ALMOST_ALL),
            removed_over_true_floor: quantiles(&over_true),
            within_tolerance: Share::of(parameters(), |parameter| parameter.error <= 1.0),
            parameter_error: [0.5, 0.9].map(|share| quantile(&errors, share)),
            covered: Share::of(parameters(), |parameter: &&ParameterRow| parameter.covered),
            covered_without_noise: Share::of(parameters().filter_map(ParameterRow::covers_without_noise), |covers| {
                *covers
            }),
            covered_within_tolerance: Share::of(parameters(), |parameter| parameter.covered_within_tolerance),
            seconds: [0.5, 1.0].map(|share| quantile(&seconds, share)),
        }
    }
}
