//! Effects that may be added to a state, each with values to begin with.

use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;
use acm_core::rig::Rig;

use super::criteria::Criteria;
use crate::fit::form::{Form, fits};
use crate::fit::problem::Problem;
use crate::fit::state::{Part, Placed, State, part};

/// One more effect, in every form that is tried.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Name with carrier and signal.
    pub label: String,
    /// States with the effect, one for each initial guess.
    pub states: Vec<State>,
    /// Number of states for each initial guess of the effect without a dependence on a signal, where the size depends
    /// on one.
    pub each: Option<usize>,
}

impl Candidate {
    /// Returns the index of the new effect in a state; none for the clock's correction.
    pub fn new_in(&self, state: &State, rig: &Rig) -> Option<usize> {
        new_in(&self.label, state, rig)
    }

    /// Returns the effect without the dependence on a signal.
    pub fn plain(&self) -> &str {
        self.label.split(" × ").next().unwrap_or_default()
    }

    /// Returns a test for states that begin near an initial guess of the effect without a dependence, given as a share
    /// of its list.
    pub fn next_to(&self, share: f64) -> impl Fn(usize) -> bool + use<> {
        let each = self.each.unwrap_or(1).max(1);
        let values = self.states.len().div_ceil(each);
        let at = share * values as f64;
        move |k: usize| ((k / each) as f64 + 0.5 - at).abs() <= NEXT
    }

    /// Returns some of the states, spread over all: enough to test whether any of them is promising.
    pub fn coarse(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.states.len()).step_by(self.states.len().div_ceil(COARSE).max(1))
    }
}

/// Returns the index of the effect that a candidate's label names: the last, where the same one is there before it.
pub fn new_in(label: &str, state: &State, rig: &Rig) -> Option<usize> {
    state.effects.iter().rposition(|placed| placed.label(rig) == label)
}

/// Distance in the list between an initial guess and one near it.
const NEXT: f64 = 1.0;

/// Number of initial guesses that every candidate is tried with.
const COARSE: usize = 10;

/// Largest number of context signals that sizes may depend on.
const CONTEXTS: usize = 6;

/// Actuators that a friction may depend on, at most.
const PRESSURES: usize = 3;

/// Number of initial guesses where the size depends on a signal.
const VARIED: usize = 6;

/// Distance from the neutral values at which an effect begins beside the simpler one that it refines, in scales.
const BESIDE: f64 = 0.005;

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
            Some(simple) if same == 0 => {
                let other = || state.effects.iter().position(|placed| is_refined_alike(&placed.instance, new));
                all.extend(find(simple).or_else(other).into_iter().flat_map(|i| in_place_of(problem, state, i, new)));
            }
            _ => (),
        }
        let varied = refined.is_none() && old.is_none_or(|i| state.effects[i].instance.context().is_none());
        for context in modulators(problem, new).into_iter().filter(|_| varied) {
            let without = old.map_or_else(|| state.clone(), |i| state.without(i));
            let Some(instance) = new.with_context(context, problem.rig) else { continue };
            let (guesses, each) = varied_guesses(problem, new, &instance, context);
            let varied = candidate(problem, &without, &instance, guesses);
            all.extend(varied.into_iter().map(|one| Candidate { each: Some(each), ..one }));
        }
    }
    all.extend((0..state.effects.len()).filter_map(|i| apart(problem, state, i, library)));
    if clock && state.clock == 0.0 && !state.effects.iter().any(|e| e.instance.effect().name() == "dead_time") {
        all.push(clock_candidate(problem, state));
    }
    all
}

/// Factors by which the values of one actuator differ from those of the others at first.
const APART: [f64; 2] = [0.5, 2.0];

/// Returns the state with an effect of the rig as a whole replaced by one of each actuator, such as the lags of servos that differ; none
/// where the effect is of the whole only, or acts on one of them already.
fn apart(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Option<Candidate> {
    let old = &state.effects[i];
    let is_of_one = |one: &Instance| {
        one.effect().name() == old.instance.effect().name() && matches!(one.carrier(), Carrier::Actuator(_))
    };
    let each: Vec<&Instance> = library.iter().filter(|one| is_of_one(one)).collect();
    let is_whole = old.instance.carrier() == Carrier::Rig && old.instance.context().is_none();
    let last = *each.last()?;
    if !is_whole || each.len() < 2 || state.effects.iter().any(|placed| is_of_one(&placed.instance)) {
        return None;
    }
    let rest = state.without(i);
    let all = |other: Option<(usize, f64)>| {
        each.iter().enumerate().fold(rest.clone(), |state, (k, instance)| {
            let factor = other.filter(|(j, _)| *j == k).map_or(1.0, |(_, factor)| factor);
            let theta = old.theta.iter().zip(instance.parameters()).map(|(value, spec)| spec.inside(factor * value));
            let placed =
                Placed { theta: theta.collect(), in_calibration: old.in_calibration, instance: (*instance).clone() };
            state.with(placed)
        })
    };
    let others = (0..each.len()).flat_map(|j| APART.map(|factor| Some((j, factor))));
    let states = std::iter::once(None).chain(others).map(all).collect();
    Some(Candidate { label: last.label(problem.rig), states, each: None })
}

/// Returns whether two effects refine the same simpler one, which acts through the same signal.
fn is_refined_alike(one: &Instance, other: &Instance) -> bool {
    let of = |instance: &Instance| instance.effect().traits().refines;
    of(one).is_some() && of(one) == of(other) && one.carrier() == other.carrier()
}

/// Returns the initial guesses; a filter takes every column at the full rate, so that it begins from fewer.
fn guesses(problem: &Problem, new: &Instance) -> Vec<Vec<f64>> {
    let all = new.initial_guesses(problem.rig);
    let most = if part(new) == Part::Filter { FILTERED } else { usize::MAX };
    let stride = all.len().div_ceil(most).max(1);
    all.into_iter().step_by(stride).collect()
}

/// Largest number of initial guesses of a filter.
const FILTERED: usize = 16;

/// Returns the effects that take the place of effect `i` of a state with more parameters.
pub fn refinements(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Vec<Candidate> {
    let simple = &state.effects[i].instance;
    let refines = |new: &&Instance| {
        new.effect().traits().refines == Some(simple.effect().name())
            && new.carrier() == simple.carrier()
            && simple.context().is_none()
    };
    library.iter().filter(refines).flat_map(|new| in_place_of(problem, state, i, new)).collect()
}

/// Returns the state with the simpler effect that effect `i` refines in its place, at the same values.
pub fn plainer(state: &State, i: usize, library: &[Instance]) -> Option<(String, State)> {
    let old = &state.effects[i];
    let simple = old.instance.effect().traits().refines?;
    let is_it = |one: &&Instance| one.effect().name() == simple && one.carrier() == old.instance.carrier();
    let instance = library.iter().find(is_it)?.clone();
    let value = |name: &str| old.instance.parameters().iter().position(|spec| spec.name == name).map(|j| old.theta[j]);
    let theta = instance.parameters().iter().map(|spec| value(&spec.name).map_or(spec.neutral, |v| spec.inside(v)));
    let placed = Placed { theta: theta.collect(), in_calibration: old.in_calibration, instance };
    let mut next = state.clone();
    next.effects[i] = std::sync::Arc::new(placed);
    Some((simple.into(), next))
}

/// Returns the state with a size of effect `i` constant, as it is in the middle of the signal's range; none where it depends on no signal.
pub fn steadied(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Option<State> {
    let old = &state.effects[i];
    let signal = old.instance.context()?.signal(problem.rig)?;
    let is_it = |one: &&Instance| {
        one.effect().name() == old.instance.effect().name() && one.carrier() == old.instance.carrier()
    };
    let instance = library.iter().find(is_it)?.clone();
    let mut theta = old.theta[..old.instance.own_parameters()].to_vec();
    let slopes = &old.theta[theta.len()..];
    for (&j, slope) in old.instance.varying().iter().zip(slopes) {
        theta[j] = instance.parameters()[j].inside(theta[j] + slope * 0.5 * (signal.low + signal.high));
    }
    let mut next = state.clone();
    next.effects[i] = std::sync::Arc::new(Placed { theta, in_calibration: old.in_calibration, instance });
    Some(next)
}

/// Returns an effect in the place of a simpler one, beginning with its values.
fn in_place_of(problem: &Problem, state: &State, i: usize, new: &Instance) -> Vec<Candidate> {
    let simple = &state.effects[i];
    let value =
        |name: &str| simple.instance.parameters().iter().position(|spec| spec.name == name).map(|j| simple.theta[j]);
    let begin = |mut guess: Vec<f64>| {
        let specs = new.parameters().iter();
        guess
            .iter_mut()
            .zip(specs)
            .for_each(|(own, spec)| *own = value(&spec.name).map_or(*own, |known| spec.inside(known)));
        guess
    };
    // Beside its neutral values it is the simpler effect, and cannot predict worse.
    let beside = |share: f64| -> Vec<f64> {
        new.parameters().iter().map(|spec| spec.inside(spec.neutral + share * spec.scale)).collect()
    };
    let beside = [BESIDE, -BESIDE].map(beside);
    let guesses = new.initial_guesses(problem.rig).into_iter().chain(beside).map(begin).collect();
    candidate(problem, &state.without(i), new, guesses)
}

/// Returns an effect in its usual place, and on the other side of those that it does not commute with.
fn candidate(problem: &Problem, state: &State, new: &Instance, guesses: Vec<Vec<f64>>) -> Vec<Candidate> {
    let mut distinct: Vec<Vec<f64>> = Vec::new();
    for guess in guesses {
        let linear = |j: usize| new.parameters()[j].linear;
        let same = |old: &Vec<f64>| (0..guess.len()).all(|j| linear(j) || old[j] == guess[j]);
        if !distinct.iter().any(same) {
            distinct.push(guess);
        }
    }
    let base = curved(problem, state, new);
    // Whether it acts in the calibration trials too is asked of the best candidates; without it their columns stay as they are.
    let in_calibration = !problem.has_calibration();
    let placed = |guess: &Vec<f64>| Placed { instance: new.clone(), theta: guess.clone(), in_calibration };
    let states = distinct.iter().map(|guess| base.with(placed(guess))).collect();
    let stride = distinct.len().div_ceil(COARSE).max(1);
    let few = distinct.iter().step_by(stride).filter(|_| part(new) == Part::Input);
    let turned = few.clone().filter_map(|guess| base.with_turned(placed(guess))).collect();
    let bent = bent(problem, state, new);
    let bent = bent.map_or_else(Vec::new, |bent| few.map(|guess| bent.with(placed(guess))).collect());
    let of = |states: Vec<State>| Candidate { label: new.label(problem.rig), states, each: None };
    [states, turned, bent].into_iter().filter(|states: &Vec<State>| !states.is_empty()).map(of).collect()
}

/// Returns the state to which an input effect is added. Without a base a constant becomes a straight line, since an
/// effect on the inputs of a constant changes nothing.
fn curved(problem: &Problem, state: &State, new: &Instance) -> State {
    if part(new) == Part::Input { sloped(problem, state) } else { state.clone() }
}

/// Degree of the map that a first effect with a memory is also tried below.
const BENT: usize = 4;

/// Returns the state with a map of degree [`BENT`] where an effect with a memory is the first one on the inputs. A map of a filtered
/// input, such as a sensor of the absolute value, may leave nothing to a straight line.
fn bent(problem: &Problem, state: &State, new: &Instance) -> Option<State> {
    let lasts =
        |new: &Instance| new.initial_guesses(problem.rig).first().is_some_and(|guess| new.memory(guess).is_some());
    let is_first = problem.base.is_none() && state.effects.is_empty() && part(new) == Part::Input && lasts(new);
    let is_small = fits(problem.rig.actuators.len(), BENT);
    (is_first && is_small && state.form.degree.unwrap_or(0) < BENT)
        .then(|| State { form: Form { degree: Some(BENT), ..state.form }, ..state.clone() })
}

fn sloped(problem: &Problem, state: &State) -> State {
    let flat = problem.base.is_none() && state.form.degree.unwrap_or(0) == 0;
    if flat { State { form: Form { degree: Some(1), ..state.form }, ..state.clone() } } else { state.clone() }
}

/// Returns whether an effect is tried. An effect that a correction absorbs, or that needs an arm where there is none,
/// is not. A filter of the outputs that no signal carries is the same on the inputs of a straight line, and a delay of the
/// outputs the same on the inputs of any static map.
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
    contexts.chain(actuators).filter(|c| *c != instance.carrier()).collect()
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

/// Returns the actuators that are read ahead, from one sample to a third of the longest trial.
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
    let of = |placed: &crate::fit::state::Placed| {
        let traits = placed.instance.effect().traits();
        let contexts = f64::from(u8::from(placed.instance.context().is_some()));
        let terms = placed.linear().len() / problem.outputs().max(1) / (1 + usize::from(contexts > 0.0));
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
    use acm_core::effects::find;

    use super::*;
    use crate::fit::bench;

    /// Oracle: Duffing's equation without its cubic term is that of a damped oscillator with the same period and damping.
    #[test]
    fn the_simpler_effect_keeps_the_values_that_both_have() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let of = |name: &str| {
            let effect = find(name).unwrap();
            effect.carriers(&rig).into_iter().map(move |carrier| (effect, carrier))
        };
        let names = ["actuator_lag", "second_order_lag", "nonlinear_stiffness"];
        let library: Vec<Instance> = names
            .iter()
            .flat_map(|name| of(name))
            .map(|(effect, carrier)| Instance::new(effect, carrier, &rig))
            .collect();
        let (_, carrier) = of("nonlinear_stiffness").next().unwrap();
        let spring = bench::placed("nonlinear_stiffness", carrier, &rig, &[0.4, 0.7, 0.1]);
        let (name, simple) = plainer(&State::bare(Form::LINEAR).with(spring), 0, &library).unwrap();
        assert_eq!(name, "second_order_lag");
        assert_eq!(simple.effects[0].instance.effect().name(), name);
        assert_eq!(simple.effects[0].theta[..2], [0.4, 0.7]);
        assert!(plainer(&simple, 0, &library).is_none());
    }
}
