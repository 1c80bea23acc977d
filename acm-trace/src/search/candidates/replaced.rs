//! States with an effect in another form: a refinement or the simpler effect in its place, a constant size, one of each actuator.

use std::f64::consts::TAU;
use std::sync::Arc;

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, ParameterSpec};

use super::candidate::{Candidate, candidate};
use crate::fit::problem::Problem;
use crate::fit::state::{Placed, State};

/// Distance from the neutral values at which a refinement starts beside the simpler effect, in scales.
const BESIDE: f64 = 0.005;

/// Returns the effects that take the place of effect `i` of a state with more parameters.
pub fn refinements(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Vec<Candidate> {
    let simple = &state.effects[i].instance;
    let refines = |new: &&Instance| {
        new.effect().traits().takes_place_of(simple.effect().name())
            && new.carrier() == simple.carrier()
            && simple.context().is_none()
    };
    library.iter().filter(refines).flat_map(|new| in_place_of(problem, state, i, new)).collect()
}

/// Returns the states with a simpler effect in the place of effect `i`, at the same values, and its name: first the effect that it
/// refines, then those that refine the same with fewer parameters.
pub fn plainer(state: &State, i: usize, library: &[Instance]) -> Vec<(String, State)> {
    let old = &state.effects[i];
    let Some(simple) = old.instance.effect().traits().refines else { return vec![] };
    let is_known = |spec: &ParameterSpec| old.value(&spec.name).is_some();
    let has_fewer = |one: &Instance| {
        one.parameters().len() < old.instance.own_parameters() && one.parameters().iter().all(is_known)
    };
    let is_relative = |one: &Instance| one.effect().traits().refines == Some(simple) && has_fewer(one);
    let beside = || library.iter().filter(|one| one.carrier() == old.instance.carrier());
    let simplest = beside().filter(|one| one.effect().name() == simple);
    let with = |instance: &Instance| {
        let theta = instance
            .parameters()
            .iter()
            .map(|spec| old.value(&spec.name).map_or(spec.neutral, |value| spec.inside(value)));
        let placed = Placed { theta: theta.collect(), in_calibration: old.in_calibration, instance: instance.clone() };
        let mut next = state.clone();
        next.effects[i] = Arc::new(placed);
        (instance.effect().name().to_string(), next)
    };
    simplest.chain(beside().filter(|one| is_relative(one))).map(with).collect()
}

/// Initial bows of a value from its line over a signal, as a share of the value in the middle.
const BOWS: [f64; 2] = [-0.2, 0.2];

/// Returns the state with a bow in the line of the values of effect `i` over a signal; none where there is no line, or one already.
pub(super) fn bowed(problem: &Problem, state: &State, i: usize) -> Option<Vec<Candidate>> {
    let old = &state.effects[i];
    let instance = old.instance.with_bow(problem.rig)?;
    let [low, high] = instance.ends()?;
    let (own, slopes) = old.theta.split_at(instance.own_parameters());
    let middle = |k: usize, j: usize| own[j] + slopes[k] * 0.5 * (low + high);
    let with = |share: f64| {
        let bow = |(k, &j): (usize, &usize)| -4.0 * share * middle(k, j) / (high - low).powi(2);
        [old.theta.clone(), instance.varying().iter().enumerate().map(bow).collect()].concat()
    };
    let is_linear = |&j: &usize| instance.parameters()[j].linear;
    let shares = if instance.varying().iter().all(is_linear) { vec![0.0] } else { BOWS.to_vec() };
    Some(candidate(problem, &state.without(i), &instance, shares.into_iter().map(with).collect()))
}

/// Returns the state with a simpler dependence of effect `i` on a signal: linear instead of bowed, or constant, as in the middle of the
/// signal's range; none where it depends on no signal.
pub fn steadied(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Option<State> {
    let old = &state.effects[i];
    let signal = old.instance.context()?.signal(problem.rig)?;
    let is_it = |one: &&Instance| {
        one.effect().name() == old.instance.effect().name() && one.carrier() == old.instance.carrier()
    };
    let instance = library.iter().find(is_it)?.clone();
    let mut theta = old.theta[..old.instance.own_parameters()].to_vec();
    let slopes = &old.theta[theta.len()..];
    let mut next = state.clone();
    if old.instance.is_bowed() {
        let instance = instance.with_context(old.instance.context()?, problem.rig)?;
        let theta = old.theta[..instance.parameters().len()].to_vec();
        next.effects[i] = Arc::new(Placed { theta, in_calibration: old.in_calibration, instance });
        return Some(next);
    }
    for (&j, slope) in old.instance.varying().iter().zip(slopes) {
        theta[j] = instance.parameters()[j].inside(theta[j] + slope * 0.5 * (signal.low + signal.high));
    }
    next.effects[i] = Arc::new(Placed { theta, in_calibration: old.in_calibration, instance });
    Some(next)
}

/// Filters of the actuators, and the same of the outputs.
const FILTERS: [(&str, &str); 4] = [
    ("creep", "measurement_creep"),
    ("actuator_lag", "measurement_lag"),
    ("second_order_lag", "measurement_second_order"),
    ("dead_time", "measurement_delay"),
];

/// Returns the state with a filter behind the nominal map that does to the outputs what effect `i` does to the actuators, at the same
/// values; none where it is no such filter, or one of some actuators only.
pub fn behind_map(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Option<State> {
    let old = &state.effects[i].instance;
    let (_, name) = FILTERS.iter().find(|(before, _)| *before == old.effect().name())?;
    let is_whole = old.carrier() == Carrier::Rig || problem.rig.actuators.len() == 1;
    let new =
        library.iter().find(|one| one.effect().name() == *name).filter(|_| is_whole && old.context().is_none())?;
    in_place_of(problem, state, i, new).into_iter().flat_map(|candidate| candidate.states).next()
}

/// Returns the state with an oscillator of the actuators as a vibration that adds to the outputs, beside another one: with several
/// resonances, none filters the whole motion.
pub(super) fn as_vibration(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Vec<Candidate> {
    let old = &state.effects[i].instance;
    let is_vibration = |one: &Instance| one.effect().name() == VIBRATION;
    let is_beside = state.effects.iter().any(|placed| is_vibration(&placed.instance));
    if old.effect().name() != OSCILLATOR || old.context().is_some() || !is_beside {
        return vec![];
    }
    let is_only = problem.rig.actuators.len() == 1;
    let of = |one: &&Instance| is_vibration(one) && (is_only || one.carrier() == old.carrier());
    library.iter().filter(of).flat_map(|new| in_place_of(problem, state, i, new)).collect()
}

/// An oscillator of the actuators, and a vibration that adds to the outputs.
const OSCILLATOR: &str = "second_order_lag";
const VIBRATION: &str = "vibration_mode";

/// Forms of hysteresis with elements of several widths.
const SEVERAL: [&str; 2] = ["prandtl_ishlinskii", "output_prandtl_ishlinskii"];

/// Returns the states with one play in the place of a hysteresis of several elements: a play that begins elsewhere in each trial looks like
/// them.
pub fn with_one_play(problem: &Problem, state: &State, library: &[Instance]) -> Vec<State> {
    let is_several = |&i: &usize| SEVERAL.contains(&state.effects[i].instance.effect().name());
    let plays = library.iter().filter(|one| one.effect().name() == PLAY);
    let at = (0..state.effects.len()).filter(is_several);
    let all = at.flat_map(|i| plays.clone().map(move |play| (i, play)));
    all.flat_map(|(i, play)| in_place_of(problem, state, i, play)).flat_map(|candidate| candidate.states).collect()
}

/// One play.
const PLAY: &str = "backlash";

/// Returns an effect in the place of a simpler one, beginning with its values.
pub(super) fn in_place_of(problem: &Problem, state: &State, i: usize, new: &Instance) -> Vec<Candidate> {
    let simple = &state.effects[i];
    let begin = |mut guess: Vec<f64>| {
        let specs = new.parameters().iter();
        guess
            .iter_mut()
            .zip(specs)
            .for_each(|(own, spec)| *own = simple.value(&spec.name).map_or(*own, |known| spec.inside(known)));
        guess
    };
    // Near its neutral values it is the simpler effect, and cannot predict worse.
    let beside = |share: f64| -> Vec<f64> {
        new.parameters().iter().map(|spec| spec.inside(spec.neutral + share * spec.scale)).collect()
    };
    let beside = [BESIDE, -BESIDE].map(beside);
    let guesses = new.initial_guesses(problem.rig).into_iter().chain(beside).map(begin).collect();
    candidate(problem, &state.without(i), new, guesses)
}

/// Initial ratios of the values of one actuator to those of the others.
const APART: [f64; 2] = [0.5, 2.0];

/// Returns the state with an effect of the rig as a whole replaced by one of each actuator, such as the lags of servos that differ; none
/// where the effect is of the whole only, or acts on one of them already.
pub(super) fn apart(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Option<Candidate> {
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

/// Returns the state with two lags in a row in the place of an oscillator that is overdamped, of each kind of which there may be two:
/// 1/((1 + s τ₁)(1 + s τ₂)) with τ = T (ζ ± √(ζ² − 1))/2π.
pub(super) fn in_a_row(problem: &Problem, state: &State, i: usize, library: &[Instance]) -> Vec<Candidate> {
    let old = &state.effects[i];
    let overdamped = old.value("damping").filter(|damping| *damping > 1.0);
    let (Some(period), Some(damping)) = (old.value("period"), overdamped) else {
        return vec![];
    };
    let apart = (damping * damping - 1.0).sqrt();
    let taus = [damping - apart, damping + apart].map(|factor| factor * period / TAU);
    let is_lag = |one: &&Instance| {
        let traits = one.effect().traits();
        traits.repeats && traits.refines == Some(LAG) && one.carrier() == old.instance.carrier()
    };
    let rest = state.without(i);
    let of = |lag: &Instance| {
        let at = lag.parameters().iter().position(|spec| spec.name == "tau")?;
        let placed = |theta: &[f64], tau: f64| {
            let mut theta = theta.to_vec();
            theta[at] = lag.parameters()[at].inside(tau);
            Placed { theta, in_calibration: old.in_calibration, instance: lag.clone() }
        };
        let mut shapes: Vec<Vec<f64>> = vec![];
        for guess in lag.initial_guesses(problem.rig) {
            let is_known = shapes.iter().any(|known| (0..guess.len()).all(|j| j == at || known[j] == guess[j]));
            shapes.extend((!is_known).then_some(guess));
        }
        let states = shapes.iter().map(|theta| taus.iter().fold(rest.clone(), |to, tau| to.with(placed(theta, *tau))));
        Some(Candidate { label: lag.label(problem.rig), states: states.collect(), each: None })
    };
    library.iter().filter(is_lag).filter_map(of).collect()
}

/// Returns the states with a dead time in the place of two linear filters of the same actuators, and what is exchanged: to first order
/// e^{−Δs} is 1/((1 + τs)(1 + 2ζs/ω + s²/ω²)) with Δ = τ + 2ζ/ω. None where there is a dead time already.
pub fn merged(problem: &Problem, state: &State, library: &[Instance]) -> Vec<(String, State)> {
    if state.effects.iter().any(|placed| placed.instance.effect().name() == DELAY) {
        return vec![];
    }
    let delayed = |i: usize, j: usize| {
        let (one, other) = (&state.effects[i], &state.effects[j]);
        let carrier = one.instance.carrier();
        let is_it = |new: &&Instance| new.effect().name() == DELAY && new.carrier() == carrier;
        let instance = library.iter().find(is_it).filter(|_| other.instance.carrier() == carrier)?.clone();
        let delay = late(one)? + late(other)?;
        let of = |spec: &ParameterSpec| if spec.name == "delay" { spec.inside(delay) } else { spec.neutral };
        let theta = instance.parameters().iter().map(of).collect();
        let [before, behind, now] = [&one.instance, &other.instance, &instance].map(|one| one.label(problem.rig));
        let placed = Placed { theta, in_calibration: one.in_calibration, instance };
        Some((format!("{before}, {behind} → {now}"), state.without(j).without(i).with(placed)))
    };
    let pairs = (0..state.effects.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    pairs.filter_map(|(i, j)| delayed(i, j)).collect()
}

/// First-order delay of a linear filter of the actuators, s; none for other effects.
fn late(placed: &Placed) -> Option<f64> {
    match placed.instance.effect().name() {
        LAG => placed.value("tau"),
        OSCILLATOR => Some(2.0 * placed.value("damping")? * placed.value("period")? / TAU),
        _ => None,
    }
}

/// The delay of the actuators.
const DELAY: &str = "dead_time";

/// The lag that those of a vessel refine.
const LAG: &str = "actuator_lag";

/// Returns whether two effects refine the same simpler one, which acts through the same signal.
pub(super) fn is_refined_alike(one: &Instance, other: &Instance) -> bool {
    let of = |instance: &Instance| instance.effect().traits().refines;
    of(one).is_some() && of(one) == of(other) && one.carrier() == other.carrier()
}

#[cfg(test)]
mod tests {
    use acm_core::effects::find;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: Duffing's equation without its cubic term is that of a damped oscillator with the same period and damping, and a brake on
    /// the mass of a spring leaves Duffing's where it does nothing.
    #[test]
    fn the_simpler_effect_keeps_the_values_that_both_have() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let of = |name: &str| {
            let effect = find(name).unwrap();
            effect.carriers(&rig).into_iter().map(move |carrier| (effect, carrier))
        };
        let names = ["actuator_lag", "second_order_lag", "nonlinear_stiffness", "coulomb_damping"];
        let library: Vec<Instance> = names
            .iter()
            .flat_map(|name| of(name))
            .map(|(effect, carrier)| Instance::new(effect, carrier, &rig))
            .collect();
        let (_, carrier) = of("nonlinear_stiffness").next().unwrap();
        let spring = bench::placed("nonlinear_stiffness", carrier, &rig, &[0.4, 0.7, 0.1]);
        let states = plainer(&State::bare(Form::LINEAR).with(spring), 0, &library);
        let [(name, simple)] = &states[..] else { panic!("{states:?}") };
        assert_eq!(name, "second_order_lag");
        assert_eq!(simple.effects[0].instance.effect().name(), name);
        assert_eq!(simple.effects[0].theta[..2], [0.4, 0.7]);
        assert!(plainer(simple, 0, &library).is_empty());
        let braked = bench::placed("coulomb_damping", carrier, &rig, &[0.4, 0.7, 0.1, 0.2]);
        let states = plainer(&State::bare(Form::LINEAR).with(braked), 0, &library);
        let found: Vec<&str> = states.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(found, ["second_order_lag", "nonlinear_stiffness"]);
        assert_eq!(states[1].1.effects[0].theta[..4], [0.4, 0.7, 0.1, 0.2]);
    }

    fn problem_of<'a>(rig: &'a acm_core::rig::Rig, series: &'a [crate::series::Series]) -> Problem<'a> {
        Problem::new(rig, series, &[1.0], None)
    }

    /// Oracle: by hand, a lag of 0.4 s and an oscillator of 2 s damped by a half are late by 0.4 + 1/π s. Where there is a dead time already,
    /// nothing is merged.
    #[test]
    fn a_lag_and_an_oscillator_merge_to_a_dead_time() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let still = vec![0.0; bench::time().len()];
        let series = [bench::series(Record::new(bench::time(), vec![still.clone()], vec![], vec![]), still)];
        let problem = problem_of(&rig, &series);
        let of = |name: &str, theta: &[f64]| bench::placed(name, Carrier::Rig, &rig, theta);
        let library = [of("dead_time", &[1.0]).instance];
        let both = State::bare(Form::LINEAR).with(of("actuator_lag", &[0.4])).with(of("second_order_lag", &[2.0, 0.5]));
        let states = merged(&problem, &both, &library);
        assert_eq!(states.len(), 1);
        let (label, state) = &states[0];
        assert!(label.ends_with("→ dead_time"), "{label}");
        assert_eq!(state.effects.len(), 1);
        assert!((state.effects[0].theta[0] - 0.4 - std::f64::consts::FRAC_1_PI).abs() < 1e-12, "{state:?}");
        assert!(merged(&problem, &both.with(of("dead_time", &[0.1])), &library).is_empty());
    }

    #[test]
    fn a_filter_goes_behind_the_map_with_its_values() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let still = vec![0.0; bench::time().len()];
        let series = [bench::series(Record::new(bench::time(), vec![still.clone()], vec![], vec![]), still)];
        let problem = problem_of(&rig, &series);
        let of = |name: &str, theta: &[f64]| bench::placed(name, Carrier::Rig, &rig, theta);
        let library = [of("measurement_second_order", &[1.0, 1.0]).instance];
        let state = State::bare(Form::LINEAR).with(of("second_order_lag", &[2.0, 0.5])).with(of("backlash", &[0.1]));
        let found: Vec<State> = (0..2).filter_map(|i| behind_map(&problem, &state, i, &library)).collect();
        assert_eq!(found.len(), 1, "a backlash is no filter");
        assert_eq!(found[0].labels(&rig), ["backlash", "measurement_second_order"]);
        let filter = found[0].effects.iter().find(|placed| placed.instance.effect().traits().is_output_filter).unwrap();
        assert_eq!(filter.theta, [2.0, 0.5]);
    }

    /// Oracle: (1 + s τ₁)(1 + s τ₂) is 1 + 2ζ s T/2π + (s T/2π)². An oscillator that swings is no two lags.
    #[test]
    fn an_overdamped_oscillator_is_two_lags_in_a_row() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let still = vec![0.0; bench::time().len()];
        let record = Record::new(bench::time(), vec![still.clone()], vec![], vec![]);
        let series = [bench::series(record, still)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let library = [bench::placed("outflow", Carrier::Rig, &rig, &[]).instance];
        let of = |damping: f64| {
            let oscillator = bench::placed("second_order_lag", Carrier::Rig, &rig, &[2.0, damping]);
            in_a_row(&problem, &State::bare(Form::LINEAR).with(oscillator), 0, &library)
        };
        assert!(of(0.9).is_empty());
        let states = of(1.6).remove(0).states;
        for state in &states {
            let [first, second] = [0, 1].map(|i| state.effects[i].theta[0]);
            assert!((first * second - (2.0 / TAU).powi(2)).abs() < 1e-12, "{first} {second}");
            assert!((first + second - 2.0 * 1.6 * 2.0 / TAU).abs() < 1e-12, "{first} {second}");
        }
        let mut bends: Vec<f64> = states.iter().map(|state| state.effects[1].theta[1]).collect();
        bends.dedup();
        assert_eq!(bends.len(), states.len(), "each shape once");
    }
}
