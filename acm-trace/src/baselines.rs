//! Initial state of a search, and the baselines without effects.
//!
//! | baseline | base | correction fitted to |
//! | --- | --- | --- |
//! | nominal | as given | none; a polynomial nominal model: the calibration trials, or all where there are none |
//! | static map | as given | the calibration trials |
//! | recalibrated | as given | calibration and development trials |
//!
//! Degree and ridge are chosen by blocks left out, as those of the result are. Where no effect is found, the result is the simplest of
//! the three that the next does not improve on: a paired t over the blocks of the development trials, which are left
//! out of the third, and which the first two have not seen where there are calibration trials.

use acm_core::augmented::AugmentedModel;
use acm_core::response::Response;

use crate::assemble::Assembled;
use crate::fit::form::Form;
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::prepared::Prepared;
use crate::search::accept::{least_t, paired_t};
use crate::search::criteria::Criteria;
use crate::search::nuisance;
use crate::search::scan::Losses;
use crate::series::Series;

/// Returns the three baselines: the nominal model, with its static map, and calibrated again.
pub(crate) fn baselines<'a>(prepared: &'a Prepared, joined: &'a [Series], criteria: &Criteria) -> [Response; 3] {
    let fitted = |series: &'a [Series]| {
        let problem = problem(prepared, series);
        let (state, _) = nuisance::choose(&problem, &start(prepared), criteria);
        Assembled::new(&problem, &state).map_or_else(|| prepared.response.clone(), |assembled| assembled.response)
    };
    let recalibrated = fitted(joined);
    let own = if prepared.calibration.is_empty() { None } else { Some(fitted(&prepared.calibration)) };
    match prepared.base() {
        Some(_) => [prepared.response.clone(), own.unwrap_or_else(|| prepared.response.clone()), recalibrated],
        None => {
            let nominal = own.unwrap_or_else(|| recalibrated.clone());
            [nominal.clone(), nominal, recalibrated]
        }
    }
}

/// Returns the baseline that is the result where no effect is found. `recalibrated` has the losses of the third, blocks left out.
pub(crate) fn simplest<'b>(
    prepared: &Prepared,
    problem: &Problem,
    baselines: &'b [Response; 3],
    recalibrated: &Losses,
    criteria: &Criteria,
) -> &'b Response {
    let edges = problem.edges();
    let trial_of = |row: usize| edges.partition_point(|edge| *edge <= row) - 1;
    let unseen: Vec<usize> = (0..problem.blocks.len())
        .filter(|&b| !problem.series[trial_of(problem.blocks.rows[b].start)].calibrates)
        .collect();
    let of = |response: &Response| -> Losses {
        let model = without_effects(prepared, response.clone());
        let residuals: Vec<_> = (0..problem.series.len()).map(|s| problem.residual_of(&model, s)).collect();
        let loss = |&b: &usize| {
            let (rows, s) = (&problem.blocks.rows[b], trial_of(problem.blocks.rows[b].start));
            residuals[s].rows(rows.start - edges[s], rows.len()).norm_squared()
        };
        unseen.iter().map(loss).collect()
    };
    let recalibrated: Losses = unseen.iter().map(|&b| recalibrated[b]).collect();
    &baselines[first_unsurpassed([of(&baselines[0]), of(&baselines[1]), recalibrated], criteria.level)]
}

/// Returns the first of three models that no later one improves on.
fn first_unsurpassed(losses: [Losses; 3], level: f64) -> usize {
    let least = least_t(losses[0].len(), level);
    let improves = |from: usize, to: usize| paired_t(&losses[from], &losses[to]) > least;
    (1..3).fold(0, |best, next| if improves(best, next) { next } else { best })
}

/// Returns a response as a model without effects.
pub(crate) fn without_effects(prepared: &Prepared, response: Response) -> AugmentedModel {
    AugmentedModel::assembled(prepared.case.rig.clone(), response, prepared.nominal.stands_for.clone(), vec![])
}

/// Returns the trials of a search.
pub(crate) fn problem<'a>(prepared: &'a Prepared, series: &'a [Series]) -> Problem<'a> {
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
        assert_eq!(first_unsurpassed([losses(1.0), losses(0.8), losses(0.81)], 0.01), 1);
        assert_eq!(first_unsurpassed([losses(1.0), losses(1.3), losses(0.7)], 0.01), 2);
        assert_eq!(first_unsurpassed([losses(1.0), losses(1.0), losses(1.02)], 0.01), 0);
    }
}
