//! One more effect in a state: its initial guesses, in its usual place and on the other side of effects that it does not commute with.

use acm_core::effects::instance::Instance;
use acm_core::effects::{Site, find};
use acm_core::rig::Rig;

use crate::fit::form::{Form, Powers};
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

    /// Returns some of the states, spread over all: enough to test whether any of them is promising. A vibration that adds to the outputs
    /// keeps all, since its valley is as narrow as its resonance.
    pub fn coarse(&self) -> impl Iterator<Item = usize> + use<> {
        let few = if adds_vibration(&self.label) { self.states.len() } else { COARSE };
        (0..self.states.len()).step_by(self.states.len().div_ceil(few.max(1)).max(1))
    }
}

/// Returns whether a label names a vibration that adds to the outputs.
pub fn adds_vibration(label: &str) -> bool {
    let name = label.split('(').next().unwrap_or_default();
    find(name).is_some_and(|effect| {
        let traits = effect.traits();
        effect.site() == Site::Output && traits.is_resonance && !traits.is_output_filter
    })
}

/// Returns the index of the effect that a candidate's label names: the last, where the same one is there before it.
pub fn new_in(label: &str, state: &State, rig: &Rig) -> Option<usize> {
    state.effects.iter().rposition(|placed| placed.label(rig) == label)
}

/// Distance in the list between an initial guess and one near it.
const NEXT: f64 = 1.0;

/// Number of initial guesses that every candidate is tried with.
const COARSE: usize = 10;

/// Returns an effect in its usual place, and on the other side of those that it does not commute with.
pub fn candidate(problem: &Problem, state: &State, new: &Instance, guesses: Vec<Vec<f64>>) -> Vec<Candidate> {
    let mut distinct: Vec<Vec<f64>> = Vec::new();
    for guess in guesses {
        let linear = |j: usize| new.parameters()[j].linear;
        let same = |old: &Vec<f64>| (0..guess.len()).all(|j| linear(j) || old[j] == guess[j]);
        if !distinct.iter().any(same) {
            distinct.push(guess);
        }
    }
    let base = curved(problem, state, new);
    // Only the best candidates are tested in the calibration trials too, whose columns stay as they are until then.
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

/// Degree of the map with which a first effect with memory is also tried.
const BENT: usize = 4;

/// Returns the state with a map of degree [`BENT`] where an effect with a memory is the first one on the inputs. A map of a filtered
/// input, such as a sensor of the absolute value, may have no linear part.
fn bent(problem: &Problem, state: &State, new: &Instance) -> Option<State> {
    let lasts =
        |new: &Instance| new.initial_guesses(problem.rig).first().is_some_and(|guess| new.memory(guess).is_some());
    let is_first = problem.base.is_none() && state.effects.is_empty() && part(new) == Part::Input && lasts(new);
    let form = Form { degree: Some(BENT), powers: Powers::ANY, ..state.form };
    (is_first && form.fits(problem.rig.actuators.len()) && state.form.degree.unwrap_or(0) < BENT)
        .then(|| State { form, ..state.clone() })
}

/// Returns the state with a straight line in the place of a constant.
pub fn sloped(problem: &Problem, state: &State) -> State {
    let flat = problem.base.is_none() && state.form.degree.unwrap_or(0) == 0;
    if flat { State { form: Form { degree: Some(1), ..state.form }, ..state.clone() } } else { state.clone() }
}
