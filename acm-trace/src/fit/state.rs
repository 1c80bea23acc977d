//! A candidate model: a nominal form, a clock correction, and effects with their values.

use std::sync::Arc;

use acm_core::effects::Mode;
use acm_core::effects::instance::Instance;
use acm_core::effects::{Commutes, Site};
use acm_core::rig::Rig;

use super::form::Form;

/// An effect with its values.
#[derive(Debug, Clone)]
pub struct Placed {
    /// The effect on this rig.
    pub instance: Instance,
    /// Parameters θ; linear parameters hold the values of the last solution.
    pub theta: Vec<f64>,
    /// Whether it acts in the calibration trials too.
    pub in_calibration: bool,
}

/// Role of an effect in the regression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Effect on the inputs of the nominal form.
    Input,
    /// Linear filter of the outputs.
    Filter,
    /// Columns of its own, linear in its sizes.
    Additive,
    /// Any other effect; it needs a strain model.
    Other,
}

/// Candidate model; see the head of this file.
#[derive(Debug, Clone)]
pub struct State {
    /// Nominal form of the state.
    pub form: Form,
    /// Delay of the actuators' time stamps, s.
    pub clock: f64,
    /// Effects in the order of action.
    pub effects: Vec<Arc<Placed>>,
    /// Modes whose unknown initial state is projected out, beside those of the effects.
    pub forgiven: Vec<Mode>,
}

impl Placed {
    /// Returns whether the effect acts in a trial that calibrates, or in one that does not.
    pub fn acts_in(&self, calibrates: bool) -> bool {
        self.in_calibration || !calibrates
    }

    /// Returns the role of the effect in the regression.
    pub fn part(&self) -> Part {
        part(&self.instance)
    }

    /// Returns the name of the effect, with its carrier and the signal that its size depends on.
    pub fn label(&self, rig: &Rig) -> String {
        self.instance.label(rig)
    }

    /// Returns the value of a parameter; none where the effect has none of that name.
    pub fn value(&self, name: &str) -> Option<f64> {
        let at = self.instance.parameters().iter().position(|spec| spec.name == name)?;
        Some(self.theta[at])
    }

    /// Returns the nonlinear parameters that a fit may move. A size of an input effect at its neutral value is not fitted, such as the
    /// play of one actuator where only another has play.
    pub fn free(&self) -> Vec<usize> {
        let specs = self.instance.parameters();
        let own = self.instance.own_parameters();
        let rests = |j: usize| j < own && specs[j].may_vary && self.theta[j] == specs[j].neutral;
        let all_rest = (0..own).filter(|&j| specs[j].may_vary).all(rests);
        (0..specs.len())
            .filter(|&j| specs[j].is_free() && !specs[j].linear)
            .filter(|&j| {
                part(&self.instance) != Part::Input || all_rest || !rests(j) || specs[j].lower < specs[j].neutral
            })
            .collect()
    }

    /// Returns the parameters that the outputs are linear in.
    pub fn linear(&self) -> Vec<usize> {
        let specs = self.instance.parameters();
        (0..specs.len()).filter(|&j| specs[j].is_free() && specs[j].linear).collect()
    }
}

/// Returns the role of an effect in the regression.
pub fn part(instance: &Instance) -> Part {
    match instance.site() {
        Site::Actuation => Part::Input,
        Site::Output if instance.effect().traits().is_output_filter => Part::Filter,
        Site::Output if instance.parameters().iter().any(|spec| spec.linear) => Part::Additive,
        _ => Part::Other,
    }
}

impl State {
    /// Returns a nominal form alone.
    pub fn bare(form: Form) -> Self {
        Self { form, clock: 0.0, effects: vec![], forgiven: vec![] }
    }

    /// Returns a copy with one more effect, at its place in the order of action.
    #[must_use]
    pub fn with(&self, new: Placed) -> Self {
        let mut next = self.clone();
        let at = next.effects.iter().position(|old| old.instance.order() > new.instance.order());
        next.effects.insert(at.unwrap_or(self.effects.len()), Arc::new(new));
        next
    }

    /// Returns a copy with one more input effect, on the other side of those that it does not commute with: filters and effects with
    /// fading memory come first, all others last. None where that is its usual place.
    #[must_use]
    pub fn with_turned(&self, new: Placed) -> Option<Self> {
        let commutes = |placed: &Placed| placed.instance.effect().traits().commutes;
        let lasts = |placed: &Placed| placed.instance.memory(&placed.theta).is_some_and(f64::is_finite);
        let goes_first = |placed: &Placed| lasts(placed) || commutes(placed) == Commutes::WithFilters;
        if commutes(&new) == Commutes::WithAll {
            return None;
        }
        let is_dynamic = goes_first(&new);
        let other = |placed: &Arc<Placed>| {
            let alike = commutes(placed) == Commutes::WithAll || goes_first(placed) == is_dynamic;
            placed.part() == Part::Input && !alike
        };
        let usual = self.effects.iter().position(|old| old.instance.order() > new.instance.order());
        let usual = usual.unwrap_or(self.effects.len());
        let at =
            if is_dynamic { self.effects.iter().position(other)? } else { self.effects.iter().rposition(other)? + 1 };
        let is_other = if is_dynamic { at < usual } else { at > usual };
        is_other.then(|| {
            let mut next = self.clone();
            next.effects.insert(at, Arc::new(new));
            next
        })
    }

    /// Returns a copy in which effect `i` acts in the calibration trials where it did not, or the reverse.
    #[must_use]
    pub fn rescoped(&self, i: usize) -> Self {
        let mut next = self.clone();
        let placed = Arc::make_mut(&mut next.effects[i]);
        placed.in_calibration = !placed.in_calibration;
        next
    }

    /// Returns a copy without effect `i`.
    #[must_use]
    pub fn without(&self, i: usize) -> Self {
        let mut next = self.clone();
        next.effects.remove(i);
        next
    }

    /// Returns a copy without effects on the inputs that have no memory.
    #[must_use]
    pub fn without_static_inputs(&self) -> Self {
        let is_static =
            |placed: &Arc<Placed>| placed.part() == Part::Input && placed.instance.effect().traits().is_static;
        let effects = self.effects.iter().filter(|placed| !is_static(placed)).cloned().collect();
        Self { effects, ..self.clone() }
    }

    /// Returns whether all effects of another set are here, with no value of theirs on a bound that it did not rest on before: such a
    /// value would stand for something else.
    pub fn keeps(&self, other: &Self, rig: &Rig) -> bool {
        let mut own: Vec<&Placed> = self.effects.iter().map(AsRef::as_ref).collect();
        self.clock == other.clock
            && other.effects.iter().all(|before| {
                let label = before.label(rig);
                let Some(same) = own.iter().position(|placed| placed.label(rig) == label) else { return false };
                let now = own.remove(same);
                let mut values = before.instance.parameters().iter().zip(before.theta.iter().zip(&now.theta));
                values.all(|(spec, (before, now))| spec.is_at_bound(*before) || !spec.is_at_bound(*now))
            })
    }

    /// Returns the labels of the effects without the signals that their sizes depend on, sorted.
    pub fn kinds(&self, rig: &Rig) -> Vec<String> {
        let kind = |label: String| label.split(" × ").next().unwrap_or_default().to_string();
        let mut kinds: Vec<String> = self.labels(rig).into_iter().map(kind).collect();
        kinds.sort();
        kinds
    }

    /// Returns the labels of the effects, sorted; the clock's correction is one of them.
    pub fn labels(&self, rig: &Rig) -> Vec<String> {
        let mut labels: Vec<String> = self.effects.iter().map(|placed| placed.label(rig)).collect();
        labels.extend((self.clock != 0.0).then(|| "clock_correction".to_string()));
        labels.sort();
        labels
    }
}

/// Ratio of two memories, and of two frequencies, below which they count as one: over a trial their fading is alike.
const ALIKE: f64 = 1.5;

/// Returns the modes of finite memory of the effects and the further ones of the state, the slowest first, each once.
pub fn modes(state: &State) -> Vec<Mode> {
    let own = state.effects.iter().flat_map(|placed| placed.instance.modes(&placed.theta));
    let mut all: Vec<Mode> = own.chain(state.forgiven.iter().copied()).filter(|mode| mode.memory.is_finite()).collect();
    all.sort_by(|a, b| b.memory.total_cmp(&a.memory));
    let mut each: Vec<Mode> = vec![];
    for mode in all {
        let near = |a: f64, b: f64| a.max(b) <= ALIKE * a.min(b);
        let is_alike = |other: &Mode| near(mode.memory, other.memory) && near(mode.frequency, other.frequency);
        if !each.iter().any(is_alike) {
            each.push(mode);
        }
    }
    each
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;

    use super::*;
    use crate::fit::bench;

    /// Oracle: the order of a servo axis, by hand: its play comes before its lag, or behind it.
    #[test]
    fn a_lag_goes_before_a_play_or_behind_it() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let [play, lag, delay] = [("backlash", 0.1), ("actuator_lag", 0.3), ("dead_time", 0.2)]
            .map(|(name, value)| bench::placed(name, Carrier::Rig, &rig, &[value]));
        let names = |state: State| -> Vec<String> {
            state.effects.iter().map(|e| e.instance.effect().name().to_string()).collect()
        };
        let bare = State::bare(Form::LINEAR);
        assert_eq!(names(bare.with(play.clone()).with(lag.clone())), ["backlash", "actuator_lag"]);
        let turned = bare.with(play.clone()).with_turned(lag.clone()).unwrap();
        assert_eq!(names(turned), ["actuator_lag", "backlash"]);
        let turned = bare.with(lag.clone()).with_turned(play.clone()).unwrap();
        assert_eq!(names(turned), ["actuator_lag", "backlash"]);
        // Filters commute, and a delay commutes with all.
        assert!(bare.with(lag.clone()).with_turned(delay.clone()).is_none());
        assert!(bare.with(play).with_turned(delay.clone()).is_none());
        assert!(bare.with(delay).with_turned(lag).is_none());
        assert!(bare.with_turned(bench::placed("actuator_lag", Carrier::Rig, &rig, &[0.3])).is_none());
    }

    /// Oracle: by hand. A saturation has no memory; a lag has one, and a term of a context signal is none of the inputs.
    #[test]
    fn static_inputs_are_left_out() {
        let rig = bench::rig(&["q"], &["c"], &["y"]);
        let all = [
            bench::placed("saturation", Carrier::Rig, &rig, &[]),
            bench::placed("actuator_lag", Carrier::Rig, &rig, &[0.3]),
            bench::placed("context_term", Carrier::Context(0), &rig, &[1.0]),
        ];
        let state = all.into_iter().fold(State::bare(Form::LINEAR), |state, placed| state.with(placed));
        let left = state.without_static_inputs();
        let names: Vec<&str> = left.effects.iter().map(|placed| placed.instance.effect().name()).collect();
        assert_eq!(names, ["actuator_lag", "context_term"]);
    }

    /// Oracle: by hand. A larger set may change values of a smaller one's effects, and not move one onto a bound.
    #[test]
    fn values_that_move_onto_a_bound_are_not_kept() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let lag = |tau: f64| bench::placed("actuator_lag", Carrier::Rig, &rig, &[tau]);
        let longest = lag(1.0).instance.parameters()[0].upper;
        let play = bench::placed("backlash", Carrier::Rig, &rig, &[0.1]);
        let of = |tau: f64| State::bare(Form::LINEAR).with(lag(tau));
        let larger = |tau: f64| of(tau).with(play.clone());
        let kept = [(0.1, 0.3), (0.1, longest), (longest, longest)];
        assert_eq!(kept.map(|(before, after)| larger(after).keeps(&of(before), &rig)), [true, false, true]);
        assert!(!State::bare(Form::LINEAR).with(play.clone()).keeps(&of(0.1), &rig));
    }
}
