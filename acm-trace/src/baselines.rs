//! Initial state of a search, and the baselines without effects.
//!
//! | baseline | base | correction fitted to |
//! | --- | --- | --- |
//! | nominal | as given | none; a polynomial nominal model: the calibration trials, or all where there are none |
//! | static map | as given | the calibration trials |
//! | recalibrated | as given | calibration and development trials |
//!
//! Degree and ridge are chosen by blocks left out, as those of the result are.

use acm_core::response::Response;

use crate::assemble::Assembled;
use crate::fit::form::Form;
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::prepared::Prepared;
use crate::search::criteria::Criteria;
use crate::search::nuisance;
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

/// Returns the trials of a search.
pub(crate) fn problem<'a>(prepared: &'a Prepared, series: &'a [Series]) -> Problem<'a> {
    Problem::new(&prepared.case.rig, series, &prepared.weight, prepared.base())
}

/// Returns the nominal form before anything is chosen.
pub(crate) fn start(prepared: &Prepared) -> State {
    State::bare(if prepared.base().is_some() { Form::GIVEN } else { Form::LINEAR })
}
