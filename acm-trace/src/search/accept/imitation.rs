//! Candidates that imitate something else: a misfit of the nominal form, encoder noise, or an effect that another cancels.

use acm_core::effects::Carrier;

use crate::fit::moved::moved;
use crate::fit::projected::project;
use crate::fit::state::{Placed, State};
use crate::search::nuisance;
use crate::search::scan::{Losses, sum};
use crate::search::scored::{Search, key};
use crate::search::smoothed;
use crate::search::tried::Tried;

impl Search<'_, '_> {
    /// Returns whether an effect moves the outputs by many times the error without effects, so that another has to
    /// cancel it.
    pub(super) fn cancels(&self, state: &State) -> bool {
        if state.effects.len() < 2 {
            return false;
        }
        let rows = self.problem.rows().max(1) as f64;
        let most = self.criteria.cancelled * (self.first / rows).sqrt();
        project(self.problem, state).is_none_or(|fitted| {
            (0..state.effects.len()).any(|i| moved(self.problem, state, &fitted, i).norm() / rows.sqrt() > most)
        })
    }

    /// Returns whether a static effect predicts no better than a static map with more freedom: then it imitates a misfit of the nominal
    /// form. An effect without a shape, such as gravity at a joint, cannot imitate that.
    pub(super) fn is_static_misfit(&mut self, state: &State, candidate: &Tried) -> bool {
        let can_bend = |new: &Placed| is_function_of_actuators(new) && has_shape(new);
        if !added(state, &candidate.state).is_some_and(can_bend) {
            return false;
        }
        let map = self.with_map(state);
        candidate.score >= self.score_of(map, state)
    }

    /// Returns whether the first effect imitates a misfit of the nominal form.
    pub(super) fn is_nominal_misfit(&mut self, state: &State, losses: &Losses, candidate: &Tried) -> bool {
        state.effects.is_empty() && self.helps_only_without_map(state, losses, &candidate.state)
    }

    /// Returns whether a more flexible static map improves a smaller set, and a larger set predicts no better where both have it: then
    /// the difference imitates a misfit of the nominal form.
    pub(in crate::search) fn helps_only_without_map(
        &mut self,
        smaller: &State,
        losses: &Losses,
        larger: &State,
    ) -> bool {
        let map = self.with_map(smaller);
        if map >= sum(losses) {
            return false;
        }
        let both = self.with_map(larger);
        self.score_of(both, larger) >= self.score_of(map, smaller)
    }

    /// Returns the sum of squares of a state beside the most flexible static map.
    pub(in crate::search) fn with_map(&mut self, state: &State) -> f64 {
        let problem = self.problem;
        *self.rivals.entry(key(state, problem)).or_insert_with(|| nuisance::most_flexible(problem, state))
    }

    /// Returns whether a state predicts as well with smoother actuators as with the candidate, and the candidate adds nothing beside these: then
    /// it imitates encoder noise.
    pub(super) fn is_noise_of_encoders(&mut self, state: &State, candidate: &Tried) -> bool {
        let problem = self.problem;
        let mut smooth = |state: &State| {
            *self.smoothed.entry(key(state, problem)).or_insert_with(|| smoothed::smallest_loss(problem, state))
        };
        let (without, with) = (smooth(state), smooth(&candidate.state));
        candidate.score >= self.score_of(without, state)
            && self.score_of(with, &candidate.state) >= self.score_of(without, state)
    }
}

/// Returns whether an effect depends on the actuators at the same instant alone.
fn is_function_of_actuators(placed: &Placed) -> bool {
    let (instance, traits) = (&placed.instance, placed.instance.effect().traits());
    let on_context = matches!(instance.carrier(), Carrier::Context(_));
    traits.is_static && !traits.is_carried && !on_context && instance.context().is_none()
}

/// Returns whether the outputs are nonlinear in a free parameter.
fn has_shape(placed: &Placed) -> bool {
    placed.instance.parameters().iter().any(|spec| spec.is_free() && !spec.linear)
}

/// Returns the effect of a state that another lacks.
fn added<'s>(smaller: &State, larger: &'s State) -> Option<&'s Placed> {
    let is_new = |placed: &&std::sync::Arc<Placed>| {
        !smaller.effects.iter().any(|old| {
            old.instance.effect().name() == placed.instance.effect().name()
                && old.instance.carrier() == placed.instance.carrier()
        })
    };
    larger.effects.iter().find(is_new).map(AsRef::as_ref)
}

#[cfg(test)]
mod tests {
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::problem::Problem;
    use crate::search::criteria::Criteria;
    use crate::search::scan::cross_validate;

    /// Oracle: y = 8 c − 8 d with d = c + 0.1 cos 3t: each term moves y by 8/√2, which is ten times the root mean square
    /// of y; of y = 0.8 cos 3t a term by itself is no more than y.
    #[test]
    fn effects_that_take_each_other_back_cancel() {
        let rig = bench::rig(&["q"], &["c", "d"], &["y"]);
        let slow: Vec<f64> = bench::time().into_iter().map(f64::sin).collect();
        let fast: Vec<f64> = bench::time().iter().map(|t| 0.1 * (3.0 * t).cos()).collect();
        let other = |share: f64| -> Vec<f64> { slow.iter().zip(&fast).map(|(s, f)| share * s + f).collect() };
        let y: Vec<f64> = fast.iter().map(|f| -8.0 * f).collect();
        let still = vec![vec![0.0; y.len()]];
        for (share, cancel) in [(1.0, true), (0.0, false)] {
            let record = Record::new(bench::time(), still.clone(), vec![slow.clone(), other(share)], vec![]);
            let series = [bench::series(record, y.clone())];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &[], &criteria);
            search.first = y.iter().map(|y| y * y).sum();
            let term = |c: usize| bench::placed("context_term", Carrier::Context(c), &rig, &[1.0]);
            let state = State::bare(Form { degree: Some(0), ..Form::LINEAR }).with(term(0)).with(term(1));
            assert_eq!(search.cancels(&state), cancel, "{share}");
        }
    }

    /// Oracle: of y = T₆(q) + d/2, with Chebyshev's polynomial, the signal c = T₆(q) adds nothing to a map of degree 10; d is needed
    /// beside the map too.
    #[test]
    fn what_a_more_flexible_map_takes_up_is_no_effect() {
        let rig = bench::rig(&["q"], &["c", "d"], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.7 * t).cos()).collect();
        let map: Vec<f64> = bench::time().iter().map(|t| (6.0 * 1.7 * t).cos()).collect();
        let other: Vec<f64> = bench::time().iter().map(|t| (4.1 * t).sin()).collect();
        let y = map.iter().zip(&other).map(|(m, d)| m + 0.5 * d).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![map, other], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let criteria = Criteria::default();
        let mut search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        let losses = cross_validate(&problem, &bare).unwrap();
        search.first = sum(&losses);
        let stands_for_misfit = [0, 1].map(|c| {
            let state = bare.with(bench::placed("context_term", Carrier::Context(c), &rig, &[1.0]));
            let losses_with = cross_validate(&problem, &state).unwrap();
            assert!(search.score(&losses_with, &state) < search.score(&losses, &bare), "{c}");
            search.helps_only_without_map(&bare, &losses, &state)
        });
        assert_eq!(stands_for_misfit, [true, false]);
    }

    /// Oracle: y = q₀ + c/20, of which q = q₀ + n with noise n is recorded. A smoother q predicts better than the term of c, which adds its
    /// part beside that too. A lag of q smooths n, and adds nothing to a smoother q.
    #[test]
    fn an_effect_beside_noise_of_encoders_is_no_noise() {
        let rig = bench::rig(&["q"], &["c"], &["y"]);
        let smooth: Vec<f64> = bench::time().iter().map(|t| (0.6 * t).sin()).collect();
        let c: Vec<f64> = bench::time().iter().map(|t| (1.7 * t).cos()).collect();
        let mut noise = bench::noise(0.3);
        let q = smooth.iter().map(|q| q + noise()).collect();
        let y = smooth.iter().zip(&c).map(|(q, c)| q + 0.05 * c).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![c], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let criteria = Criteria::default();
        let mut search = Search::plain(&problem, &[], &criteria);
        let bare = State::bare(Form::LINEAR);
        search.first = sum(&cross_validate(&problem, &bare).unwrap());
        let term = bench::placed("context_term", Carrier::Context(0), &rig, &[1.0]);
        let lag = bench::placed("actuator_lag", Carrier::Rig, &rig, &[0.03]);
        let found = [term, lag].map(|placed| {
            let (label, state) = (placed.label(&rig), bare.with(placed));
            let losses = cross_validate(&problem, &state).unwrap();
            let score = search.score(&losses, &state);
            assert!(score < search.score_of(search.first, &bare), "{label}");
            let tried = Tried { label, state, score, scanned: score, losses, is_refined: true };
            search.is_noise_of_encoders(&bare, &tried)
        });
        assert_eq!(found, [false, true]);
    }
}
