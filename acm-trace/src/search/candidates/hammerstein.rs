//! A map before a lag that has no linear form: a filter of the outputs becomes a bent input with a lag behind it.
//!
//! A static map with a filter of the outputs behind it is a Hammerstein model; so is a bent input with a lag of the inputs behind it,
//! and a straight line. Only the second may have a lag that depends on where it is: the filter acts on every column of the map.

use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;

use super::candidate::Candidate;
use crate::fit::form::Form;
use crate::fit::problem::Problem;
use crate::fit::state::{Placed, State};

/// Filters of the outputs, and the lags of the inputs with the same parameters.
const LAGS: [(&str, &str); 2] = [("measurement_lag", "actuator_lag"), ("measurement_second_order", "second_order_lag")];

/// Effect that bends the inputs.
const BEND: &str = "input_nonlinearity";

/// Returns the state with filter `i` as each refinement of the lag with its parameters, behind a bent input; nothing where the effect is
/// no filter of all outputs, where an effect acts on the inputs already, or beside a base.
pub(super) fn hammerstein(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Vec<Candidate> {
    let filter = &state.effects[i];
    let of_filter = |(name, _): &&(&str, &str)| filter.instance.effect().name() == *name;
    let Some((_, lag)) = LAGS.iter().find(of_filter) else { return vec![] };
    let is_whole = |one: &Instance| one.carrier() == Carrier::Rig && one.context().is_none();
    let bend = library.iter().find(|one| one.effect().name() == BEND && is_whole(one));
    let bends = || state.effects.iter().any(|placed| placed.instance.effect().name() == BEND);
    let Some(bend) = bend.filter(|_| problem.base.is_none() && is_whole(&filter.instance) && !bends()) else {
        return vec![];
    };
    let rest = State { form: Form { ridge: state.form.ridge, ..Form::LINEAR }, ..state.without(i) };
    let refines = |new: &&Instance| new.effect().traits().refines == Some(*lag) && is_whole(new);
    library.iter().filter(refines).map(|new| behind_a_bend(problem, (&rest, filter), bend, new)).collect()
}

/// Returns a lag behind a bent input, at the values of a filter that it shares with it.
fn behind_a_bend(problem: &Problem, (rest, filter): (&State, &Placed), bend: &Instance, lag: &Instance) -> Candidate {
    let placed = |instance: &Instance, theta: Vec<f64>| Placed {
        instance: instance.clone(),
        theta,
        in_calibration: filter.in_calibration,
    };
    let value =
        |name: &str| filter.instance.parameters().iter().position(|spec| spec.name == name).map(|j| filter.theta[j]);
    let begin = |guess: Vec<f64>| -> Vec<f64> {
        let specs = lag.parameters().iter().zip(guess);
        specs.map(|(spec, own)| value(&spec.name).map_or(own, |known| spec.inside(known))).collect()
    };
    let mut lags: Vec<Vec<f64>> = Vec::new();
    for guess in lag.initial_guesses(problem.rig).into_iter().map(begin) {
        if !lags.contains(&guess) {
            lags.push(guess);
        }
    }
    let bends = bend.initial_guesses(problem.rig);
    let with = |bent: &Vec<f64>| {
        let bent = rest.with(placed(bend, bent.clone()));
        lags.iter().map(move |theta| bent.with(placed(lag, theta.clone()))).collect::<Vec<State>>()
    };
    Candidate { label: lag.label(problem.rig), states: bends.iter().flat_map(with).collect(), each: None }
}
