//! Initial state of a search, and the baselines without effects.
//!
//! | baseline | base | correction fitted to |
//! | --- | --- | --- |
//! | nominal | as calibrated | none; a polynomial nominal model: the calibration trials, or all where there are none |
//! | static map | as in use | the calibration trials |
//! | recalibrated | as in use | calibration and development trials |
//!
//! The model in use is the nominal model, completed from the development trials where possible ([`crate::nominal_fit::Nominal::in_use`]).
//! Degree and ridge are chosen by cross-validation, as for the result. Without effects, the result is the simplest baseline that the next
//! does not improve on, by a paired t over the blocks of the development trials, which are left out of the third. With calibration trials,
//! the first has not seen the development trials, and the second only through the completion of its base. Effects are accepted against the
//! third; where another baseline is the result without them, they must improve on it too.

use acm_core::augmented::AugmentedModel;
use acm_core::response::Response;

use crate::assemble::Assembled;
use crate::fit::form::Form;
use crate::fit::offsets::without_offset;
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::prepared::Prepared;
use crate::search::accept::{least_t, paired_t};
use crate::search::criteria::Criteria;
use crate::search::nuisance;
use crate::search::scan::Losses;
use crate::series::Series;

/// Index of the third baseline.
pub(crate) const RECALIBRATED: usize = 2;

/// Returns the three baselines: nominal, static map, recalibrated.
pub(crate) fn baselines<'a>(prepared: &'a Prepared, joined: &'a [Series], criteria: &Criteria) -> [Response; 3] {
    let fitted = |series: &'a [Series]| {
        let problem = problem(prepared, series);
        let (state, _) = nuisance::choose(&problem, &start(prepared), criteria);
        Assembled::new(&problem, &state).map_or_else(|| prepared.response.clone(), |assembled| assembled.response)
    };
    let recalibrated = fitted(joined);
    let own = if prepared.calibration.is_empty() { None } else { Some(fitted(&prepared.calibration)) };
    match prepared.base() {
        Some(_) => {
            let nominal = Response::new(prepared.nominal.model.clone(), None, prepared.down());
            [nominal.clone(), own.unwrap_or(nominal), recalibrated]
        }
        None => {
            let nominal = own.unwrap_or_else(|| recalibrated.clone());
            [nominal.clone(), nominal, recalibrated]
        }
    }
}

/// Returns the index of the simplest baseline that the next does not improve on; `recalibrated` has the cross-validated losses of the
/// third.
pub(crate) fn simplest(
    prepared: &Prepared,
    problem: &Problem,
    baselines: &[Response; 3],
    recalibrated: &Losses,
    level: f64,
) -> usize {
    // A polynomial without calibration trials is fitted to the trials that it would be compared on.
    if prepared.base().is_none() && prepared.calibration.is_empty() {
        return 0;
    }
    let of = |response: &Response| losses_of(prepared, problem, response);
    let recalibrated = of_development(problem, recalibrated);
    first_unsurpassed(&[of(&baselines[0]), of(&baselines[1]), recalibrated], level)
}

/// Returns whether a model with effects improves on a baseline, without trial offsets; `losses` are cross-validated.
pub(crate) fn is_improved_on(
    baseline: &Response,
    prepared: &Prepared,
    problem: &Problem,
    losses: &Losses,
    level: f64,
) -> bool {
    improves(&losses_of(prepared, problem, baseline), &of_development(problem, losses), level)
}

/// Returns the residual sum of squares of a baseline in each block of the development trials.
fn losses_of(prepared: &Prepared, problem: &Problem, response: &Response) -> Losses {
    let model = without_effects(prepared, response.clone());
    let of = |s: usize| without_offset(problem.offset_share, problem.residual_of(&model, s));
    let residuals: Vec<_> = (0..problem.series.len()).map(of).collect();
    let edges = problem.edges();
    let blocks = problem.blocks.rows.iter().zip(&problem.blocks.trial);
    let losses = blocks.map(|(rows, &s)| residuals[s].rows(rows.start - edges[s], rows.len()).norm_squared());
    of_development(problem, &losses.collect())
}

/// Returns the losses of the blocks of development trials.
fn of_development(problem: &Problem, losses: &Losses) -> Losses {
    let blocks = losses.iter().zip(&problem.blocks.trial);
    blocks.filter(|(_, s)| !problem.series[**s].calibrates).map(|(loss, _)| *loss).collect()
}

/// Returns the first of three models that no later one improves on.
fn first_unsurpassed(losses: &[Losses; 3], level: f64) -> usize {
    (1..3).fold(0, |best, next| if improves(&losses[best], &losses[next], level) { next } else { best })
}

/// Returns whether the losses fall: a paired t over blocks.
fn improves(from: &Losses, to: &Losses, level: f64) -> bool {
    paired_t(from, to) > least_t(from.len(), level)
}

/// Returns a response as a model without effects.
pub(crate) fn without_effects(prepared: &Prepared, response: Response) -> AugmentedModel {
    AugmentedModel::assembled(prepared.case.rig.clone(), response, prepared.nominal.stands_for.clone(), vec![])
}

/// Returns the trials of a search.
pub(crate) fn problem<'a>(prepared: &'a Prepared, series: &[Series]) -> Problem<'a> {
    Problem::new(&prepared.case.rig, series, &prepared.weight, prepared.base())
}

/// Returns the nominal form before anything is chosen.
pub(crate) fn start(prepared: &Prepared) -> State {
    State::bare(if prepared.base().is_some() { Form::GIVEN } else { Form::LINEAR })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Block 3 holds a slip, which is most of every sum; the others decide.
    #[test]
    fn a_slip_does_not_hide_the_better_baseline() {
        let losses = |share: f64| -> Losses {
            (0..12).map(|b| if b == 3 { 500.0 } else { share * (10.0 + f64::from(7 * b % 5)) }).collect()
        };
        assert_eq!(first_unsurpassed(&[losses(1.0), losses(0.8), losses(0.81)], 0.01), 1);
        assert_eq!(first_unsurpassed(&[losses(1.0), losses(1.3), losses(0.7)], 0.01), 2);
        assert_eq!(first_unsurpassed(&[losses(1.0), losses(1.0), losses(1.02)], 0.01), 0);
    }
}
