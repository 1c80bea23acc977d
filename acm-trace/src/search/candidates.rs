//! Effects that may be added to a state, each with initial values.

mod candidate;
mod replaced;

use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;

use super::criteria::Criteria;
use crate::fit::problem::Problem;
use crate::fit::state::{Part, Placed, State, part};
use candidate::{candidate, sloped};
use replaced::{apart, as_vibration, bowed, in_a_row, in_place_of, is_refined_alike};

pub use candidate::{Candidate, adds_vibration, new_in};
pub use replaced::{behind_map, merged, plainer, refinements, steadied, with_one_play};

/// Largest number of context signals that sizes may depend on.
const CONTEXTS: usize = 6;

/// Actuators that a friction may depend on, at most.
const PRESSURES: usize = 3;

/// Number of initial guesses where the size depends on a signal.
const VARIED: usize = 6;

/// Relative changes of a size from the middle of a signal's range to its end.
const SLOPES: [f64; 2] = [-0.9, 0.9];

/// Largest number of the same effect, where several of them add up.
const REPEATED: usize = 2;

/// Name of the correction of the actuators' clock.
pub const CLOCK: &str = "clock_correction";

/// Returns all candidates for a state.
pub fn candidates(problem: &Problem, state: &State, library: &[Instance], clock: bool) -> Vec<Candidate> {
    let mut all = Vec::new();
    for new in library.iter().filter(|new| is_possible(problem, state, new)) {
        let has = |name: &str, old: &Instance| old.effect().name() == name && old.carrier() == new.carrier();
        let find = |name: &str| state.effects.iter().position(|placed| has(name, &placed.instance));
        let old = find(new.effect().name());
        let refined = new.effect().traits().refines;
        let same = state.effects.iter().filter(|placed| has(new.effect().name(), &placed.instance)).count();
        let most = if new.effect().traits().repeats { REPEATED } else { 1 };
        match refined {
            None if same < most => all.extend(candidate(problem, state, new, guesses(problem, new))),
            Some(simple) if same < most => {
                let is_other = |placed: &Placed| same == 0 && is_refined_alike(&placed.instance, new);
                let other = || state.effects.iter().position(|placed| is_other(placed));
                let replaced = || new.effect().traits().replaces.and_then(find);
                let place = find(simple).or_else(replaced).or_else(other);
                all.extend(place.into_iter().flat_map(|i| in_place_of(problem, state, i, new)));
            }
            _ => (),
        }
        let varied = refined.is_none() && old.is_none_or(|i| state.effects[i].instance.context().is_none());
        for context in modulators(problem, new).into_iter().filter(|_| varied) {
            let without = old.map_or_else(|| state.clone(), |i| state.without(i));
            let mut dependent = new.with_context(context, problem.rig);
            // A dependence that is symmetric about the middle has no slope.
            if context == new.carrier() {
                dependent = dependent.and_then(|line| line.with_bow(problem.rig));
            }
            let Some(instance) = dependent else { continue };
            let (guesses, each) = varied_guesses(problem, new, &instance, context);
            let varied = candidate(problem, &without, &instance, guesses);
            all.extend(varied.into_iter().map(|one| Candidate { each: Some(each), ..one }));
        }
    }
    all.extend((0..state.effects.len()).filter_map(|i| apart(problem, state, i, library)));
    all.extend((0..state.effects.len()).flat_map(|i| in_a_row(problem, state, i, library)));
    all.extend((0..state.effects.len()).flat_map(|i| as_vibration(problem, state, i, library)));
    all.extend((0..state.effects.len()).filter_map(|i| bowed(problem, state, i)).flatten());
    if clock && state.clock == 0.0 && !state.effects.iter().any(|e| e.instance.effect().name() == "dead_time") {
        all.push(clock_candidate(problem, state));
    }
    all
}

/// Returns the initial guesses; fewer for a filter, which takes every column at the full rate.
fn guesses(problem: &Problem, new: &Instance) -> Vec<Vec<f64>> {
    let all = new.initial_guesses(problem.rig);
    let most = if part(new) == Part::Filter { FILTERED } else { usize::MAX };
    let stride = all.len().div_ceil(most).max(1);
    all.into_iter().step_by(stride).collect()
}

/// Largest number of initial guesses of a filter.
const FILTERED: usize = 16;

/// Returns whether an effect is tried. An effect that a correction absorbs, or that needs an arm where there is none, is not. An output
/// filter that no signal carries equals one of the inputs of a linear map, and an output delay one of the inputs of any static map.
fn is_possible(problem: &Problem, state: &State, new: &Instance) -> bool {
    let on_an_arm = problem.base.is_some_and(|base| base.strain.is_some());
    let traits = new.effect().traits();
    let is_static = state.effects.iter().all(|placed| placed.part() == Part::Input);
    let is_straight = problem.base.is_none() && state.form.degree.unwrap_or(0) <= 1;
    match part(new) {
        Part::Input | Part::Additive => on_an_arm && problem.has_calibration() || !traits.is_calibrated_away,
        Part::Filter if new.carrier() == Carrier::Rig => !(is_static && (is_straight || is_delay(problem, new))),
        Part::Filter => true,
        Part::Other => on_an_arm,
    }
}

fn is_delay(problem: &Problem, filter: &Instance) -> bool {
    filter.initial_guesses(problem.rig).first().is_some_and(|guess| filter.memory(guess).is_none())
}

/// Returns the signals on which the size of an effect may depend: contexts, and for friction the other actuators.
pub fn modulators(problem: &Problem, instance: &Instance) -> Vec<Carrier> {
    let (traits, rig) = (instance.effect().traits(), problem.rig);
    let lasts = instance.initial_guesses(rig).first().is_some_and(|guess| instance.memory(guess).is_some());
    if traits.is_constant || traits.is_generic || traits.is_output_filter || lasts {
        return vec![];
    }
    let varies = |c: &Carrier| c.signal(rig).is_some_and(acm_core::rig::Signal::varies);
    let contexts = (0..rig.contexts.len()).map(Carrier::Context).filter(varies).take(CONTEXTS);
    let few = traits.follows_pressure && rig.actuators.len() <= PRESSURES;
    let actuators = (0..if few { rig.actuators.len() } else { 0 }).map(Carrier::Actuator).filter(varies);
    contexts.chain(actuators).collect()
}

/// Returns the initial guesses, and how many of them belong to each guess of the plain effect.
fn varied_guesses(problem: &Problem, plain: &Instance, varied: &Instance, context: Carrier) -> (Vec<Vec<f64>>, usize) {
    let guesses = plain.initial_guesses(problem.rig);
    let stride = guesses.len().div_ceil(VARIED).max(1);
    let thinned = guesses.into_iter().step_by(stride);
    let slopes = varied.parameters().len() - varied.own_parameters();
    let all_linear = varied.varying().iter().all(|&j| varied.parameters()[j].linear);
    if all_linear {
        return (thinned.map(|guess| [guess, vec![0.0; slopes]].concat()).collect(), 1);
    }
    let (low, high) = context.signal(problem.rig).map_or((0.0, 1.0), |signal| (signal.low, signal.high));
    let tilted = |guess: Vec<f64>| {
        SLOPES.map(|share| {
            let mut theta = guess.clone();
            let mut tail = Vec::new();
            for &j in varied.varying() {
                let slope = 2.0 * share * guess[j] / (high - low);
                theta[j] -= slope * 0.5 * (low + high);
                tail.push(slope);
            }
            theta.extend(tail);
            theta
        })
    };
    (thinned.flat_map(tilted).collect(), SLOPES.len())
}

/// Returns states with a clock correction, from one sample to a third of the longest trial.
fn clock_candidate(problem: &Problem, state: &State) -> Candidate {
    let times = acm_core::effects::times::grid(problem.rig);
    let base = sloped(problem, state);
    let states = times.into_iter().map(|clock| State { clock, ..base.clone() }).collect();
    Candidate { label: CLOCK.into(), states, each: None }
}

/// Returns the price of a state's effects: one price for each physical term, more for forms that fit almost anything,
/// for rare effects where a common one does as well, for a dependence on a signal, and a little for each parameter that
/// the outputs are not linear in.
pub fn price(problem: &Problem, state: &State, criteria: &Criteria) -> f64 {
    let of = |placed: &Placed| {
        let traits = placed.instance.effect().traits();
        let instance = &placed.instance;
        let lines = usize::from(instance.context().is_some()) + usize::from(instance.is_bowed());
        let (contexts, terms) = (lines as f64, placed.linear().len() / problem.outputs().max(1) / (1 + lines));
        let form = if traits.is_generic { criteria.generic } else { (terms as f64).max(1.0) };
        let rare = if traits.is_rare || traits.is_output_filter { criteria.rare } else { 0.0 };
        let more = placed.free().len().max(1) - 1;
        form + rare + criteria.context * contexts + criteria.parameter * more as f64
    };
    let effects: f64 = state.effects.iter().map(|placed| of(placed)).sum();
    criteria.price * (effects + if state.clock == 0.0 { 0.0 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: by hand; a lag of 0.5 s of three actuators becomes three, all of 0.5 s, or one of them of half or twice that. Where one
    /// actuator has a lag of its own already, nothing is split.
    #[test]
    fn a_lag_of_all_actuators_comes_apart() {
        let rig = bench::rig(&["a", "b", "c"], &[], &["y"]);
        let still = vec![0.0; bench::time().len()];
        let record = Record::new(bench::time(), vec![still.clone(); 3], vec![], vec![]);
        let series = [bench::series(record, still)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let of = |carrier: Carrier| bench::placed("actuator_lag", carrier, &rig, &[0.5]);
        let library: Vec<Instance> = std::iter::once(Carrier::Rig)
            .chain((0..3).map(Carrier::Actuator))
            .map(|carrier| of(carrier).instance)
            .collect();
        let apart = |state: &State| -> Vec<Vec<f64>> {
            let all = candidates(&problem, state, &library, false).into_iter().flat_map(|one| one.states);
            let each = all.filter(|state| state.effects.iter().all(|placed| placed.instance.carrier() != Carrier::Rig));
            each.map(|state| state.effects.iter().map(|placed| placed.theta[0]).collect()).collect()
        };
        let whole = State::bare(Form::LINEAR).with(of(Carrier::Rig));
        let expected = [
            [0.5, 0.5, 0.5],
            [0.25, 0.5, 0.5],
            [1.0, 0.5, 0.5],
            [0.5, 0.25, 0.5],
            [0.5, 1.0, 0.5],
            [0.5, 0.5, 0.25],
            [0.5, 0.5, 1.0],
        ];
        assert_eq!(apart(&whole), expected);
        assert_eq!(apart(&whole.with(of(Carrier::Actuator(1)))), Vec::<Vec<f64>>::new());
    }

    /// Oracle: a joint has a moment of inertia, viscous and Coulomb friction at once; with any of them in the model the others are tried.
    #[test]
    fn frictions_and_inertia_of_a_joint_go_together() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.7 * t).sin()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), q)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let all = ["inertia", "viscous_friction", "coulomb_friction"];
        let of = |name: &str| bench::placed(name, Carrier::Actuator(0), &rig, &[]);
        let library: Vec<Instance> = all.iter().map(|name| of(name).instance).collect();
        for first in all {
            let state = State::bare(Form::LINEAR).with(of(first));
            let found = candidates(&problem, &state, &library, false);
            let named =
                |state: &State, name: &str| state.effects.iter().any(|placed| placed.instance.effect().name() == name);
            let goes_with = |name: &str| {
                let mut states = found.iter().flat_map(|one| &one.states);
                states.any(|state| named(state, first) && named(state, name))
            };
            for other in all.into_iter().filter(|other| *other != first) {
                assert!(goes_with(other), "{other} beside {first}");
            }
        }
    }
}
