//! Alternatives to linear interpolation of actuators between samples.

use acm_core::InterSample;

use crate::fit::problem::Problem;
use crate::prepared::Prepared;
use crate::search::criteria::Criteria;
use crate::search::scan::cross_validate;
use crate::search::select::{Search, Selected, sum};
use crate::series::curved::{curved, missed, too_fast};
use crate::series::stepwise::stepwise;

/// Returns the alternatives to the present behaviour: quartic or hold instead of linear, hold instead of quartic.
pub(super) fn may_go_otherwise(
    prepared: &Prepared,
    now: &InterSample,
    search: &Search,
    selected: &Selected,
) -> Vec<InterSample> {
    let case = &prepared.case;
    let stepwise = stepwise(case);
    let share = share_left(search.problem, sum(&selected.last_losses));
    let missed = missed(case);
    let bent = curved(&missed, share).into_iter().filter(|a| !stepwise.contains(a)).collect();
    let mut held = [stepwise, too_fast(&missed)].concat();
    held.sort_unstable();
    held.dedup();
    let mut all = match now {
        InterSample::Straight => vec![InterSample::Quartic(bent), InterSample::Held(held)],
        InterSample::Quartic(_) => vec![InterSample::Held(held)],
        InterSample::Held(_) => vec![],
    };
    all.retain(|between| !between.actuators().is_empty());
    all
}

/// Returns whether the error of what was found changes on other trials by the price of an effect: then inter-sample behaviour matters.
pub(super) fn is_moved(problem: &Problem, selected: &Selected, criteria: &Criteria) -> bool {
    let now = cross_validate(problem, &selected.last).map_or(f64::NAN, |losses| sum(&losses));
    let change = (now / sum(&selected.last_losses)).ln().abs();
    change.is_nan() || change > criteria.price
}

/// Returns the root of a sum of squares relative to that of the outputs.
fn share_left(problem: &Problem, left: f64) -> f64 {
    let moved: f64 =
        problem.targets.iter().flat_map(|targets| targets.column_iter().map(|y| y.variance() * y.len() as f64)).sum();
    (left / moved).sqrt()
}

/// Describes the inter-sample behaviour.
pub(super) fn told_between(prepared: &Prepared, inter_sample: &InterSample) -> String {
    let names: Vec<&str> =
        inter_sample.actuators().iter().map(|&a| prepared.case.rig.actuators[a].name.as_str()).collect();
    let what = if matches!(inter_sample, InterSample::Quartic(_)) { "a quartic" } else { "held" };
    format!("{} {what} between samples", names.join(", "))
}
