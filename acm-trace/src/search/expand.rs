//! One expansion of a state: every candidate scanned, and the best refined together with the rest.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::candidates::{Candidate, adds_vibration, candidates, new_in, refinements, with_one_play};
use super::nuisance;
use super::scan::{Losses, Scanned, cross_validate, scan, sum};
use super::scored::{Scored, Search, key};
use crate::fit::design::keep;
use crate::fit::projected::project;
use crate::fit::refine::{refine, steps};
use crate::fit::state::State;

pub use super::tried::{Expansion, Tried};

/// Largest number of steps of a refinement of one candidate, and of a set.
const ITERATIONS: (usize, usize) = (6, 5);

/// Largest number of steps of a set on all samples.
const POLISHED: usize = 10;

/// Difference of J up to which sets of the same effects have the same candidates, in prices.
const ALIKE: f64 = 0.1;

/// A hysteresis of several elements behind the map, and the same before it.
const TWINS: [&str; 2] = ["output_prandtl_ishlinskii", "prandtl_ishlinskii"];

/// Moves a hysteresis of several elements before the map to the first `first` candidates where the one behind it is among these: a scan, in
/// which its weights are not free, says little about it. Returns how many come first then.
fn with_twin(tried: &mut Vec<Tried>, first: usize) -> usize {
    let is = |one: &Tried, k: usize| one.label.split('(').next() == Some(TWINS[k]);
    let twin = tried.iter().position(|one| is(one, 1)).filter(|twin| *twin >= first);
    let Some(twin) = twin.filter(|_| tried[..first].iter().any(|one| is(one, 0))) else { return first };
    let twin = tried.remove(twin);
    tried.insert(first, twin);
    first + 1
}

impl Search<'_, '_> {
    /// Returns a state with its values refined and its form chosen again.
    pub fn settled(&mut self, state: &State) -> Scored {
        let key = key(state, self.problem);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let refined = refine(self.quick, state, steps(&state.effects, ITERATIONS.1));
        let (chosen, losses) = nuisance::choose(self.problem, &refined, self.criteria);
        let settled = (self.score(&losses, &chosen), chosen, losses);
        self.known.insert(key, settled.clone());
        settled
    }

    /// Returns the best of the sets with one play in the place of a hysteresis of several elements; none where there is no such effect.
    pub fn with_one_play(&mut self, state: &State) -> Option<State> {
        let loss = |state: &State| cross_validate(self.quick, state).map_or(f64::INFINITY, |losses| sum(&losses));
        let all = with_one_play(self.problem, state, self.library);
        let best = all.into_iter().map(|state| (loss(&state), state)).min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(self.settled(&best.1).1)
    }

    /// Returns a set with its values refined on all samples, where that predicts better, also as it is saved.
    pub(super) fn polished(&self, last: Scored) -> Scored {
        let refined = refine(self.problem, &last.1, steps(&last.1.effects, POLISHED));
        let (chosen, losses) = nuisance::choose(self.problem, &refined, self.criteria);
        let score = self.score(&losses, &chosen);
        let is_better = score < last.0 && self.is_better_as_saved((score, &chosen), (last.0, &last.1));
        if is_better { (score, chosen, losses) } else { last }
    }

    /// Returns a set of other trials with its losses on these, and its values refined where that predicts better and drives none of them
    /// to its bound.
    pub fn polished_again(&self, (state, losses): (State, Losses)) -> (State, Losses) {
        let losses = cross_validate(self.problem, &state).unwrap_or(losses);
        let (_, refined, refined_losses) = self.polished((self.score(&losses, &state), state.clone(), losses.clone()));
        if refined.keeps(&state, self.problem.rig) { (refined, refined_losses) } else { (state, losses) }
    }

    /// Returns all candidates on a state. The first are refined, best first, then follow the others.
    pub fn expand(&mut self, state: &State) -> Expansion {
        let key = key(state, self.problem);
        if let Some(known) = self.expanded.get(&key) {
            return known.clone();
        }
        let score = cross_validate(self.problem, state).map_or(f64::INFINITY, |losses| self.score(&losses, state));
        if let Some(known) = self.known_expansion(state, score) {
            return known;
        }
        keep(self.quick, state);
        let all = candidates(self.problem, state, self.library, self.clock);
        let beta =
            project(self.quick, state).map_or_else(|| DMatrix::zeros(0, self.problem.outputs()), |fitted| fitted.beta);
        let scanned = scan(self.quick, state, &all, &beta);
        let mut tried: Vec<Tried> =
            all.iter().zip(scanned).filter_map(|(candidate, scanned)| Some(self.tried(candidate, scanned?))).collect();
        tried.sort_by(|a, b| a.score.total_cmp(&b.score));
        // A vibration looks like any oscillator in a scan: one is refined in addition to the others.
        let (vibrations, mut tried): (Vec<Tried>, Vec<Tried>) =
            tried.into_iter().partition(|one| adds_vibration(&one.label));
        let first = self.criteria.refined.min(tried.len());
        let has_twin = state.effects.iter().any(|placed| TWINS.contains(&placed.instance.effect().name()));
        let first = if has_twin { first } else { with_twin(&mut tried, first) };
        let refined = first + vibrations.len().min(1);
        tried.splice(first..first, vibrations);
        let mut better: Vec<Tried> = tried[..refined].par_iter().map(|one| self.refined(one)).collect();
        better.sort_by(|a, b| a.score.total_cmp(&b.score));
        let others = better.iter().filter(|one| !adds_vibration(&one.label));
        let first: Vec<&Tried> = others.take(self.criteria.beam).collect();
        let further: Vec<Tried> = first.par_iter().flat_map_iter(|one| self.further(one)).collect();
        better.extend(further);
        better.sort_by(|a, b| a.score.total_cmp(&b.score));
        // The rest was only looked at to first order.
        tried.splice(..refined, better);
        self.of_labels.entry(state.labels(self.problem.rig)).or_default().push((score, key.clone()));
        self.expanded.insert(key, tried.clone());
        tried
    }

    /// Returns the candidates on a state of the same effects and about the same J, which are as good on this one.
    fn known_expansion(&self, state: &State, score: f64) -> Option<Expansion> {
        let near = self.criteria.price * ALIKE;
        let known = self.of_labels.get(&state.labels(self.problem.rig))?;
        let (_, key) = known.iter().find(|(other, _)| (other - score).abs() < near)?;
        self.expanded.get(key).cloned()
    }

    fn tried(&self, candidate: &Candidate, scanned: Scanned) -> Tried {
        let state = candidate.states[scanned.best].clone();
        // Scaled to the samples of refined candidates.
        let share = self.problem.rows() as f64 / self.quick.rows().max(1) as f64;
        let losses: Losses = scanned.losses.iter().map(|loss| share * loss).collect();
        let score = self.score(&losses, &state);
        Tried { label: candidate.label.clone(), score, scanned: score, state, losses, is_refined: false }
    }

    /// Returns effects with more parameters in the place of the new effect, beginning with its refined values; and the
    /// effect itself, refined as long.
    fn further(&self, one: &Tried) -> Vec<Tried> {
        let Some(new) = new_in(&one.label, &one.state, self.problem.rig) else { return vec![] };
        let first = |candidate: Candidate| {
            let scored = |state: State| Some((sum(&cross_validate(self.quick, &state)?), state));
            let tried = candidate.states.into_iter().filter_map(scored);
            let (_, state) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(self.refined(&Tried { label: candidate.label, state, ..one.clone() }))
        };
        let refinements = refinements(self.problem, &one.state, new, self.library);
        let mut further: Vec<Tried> = refinements.into_iter().filter_map(first).collect();
        if !further.is_empty() {
            further.push(self.refined(one));
        }
        further
    }

    /// Returns the refined state, with the new effect in the calibration trials too where that predicts better.
    fn scoped(&self, one: &Tried) -> State {
        let new = new_in(&one.label, &one.state, self.problem.rig);
        // A resonance of the old state has already converged.
        let of_new = |new: usize| steps(&one.state.effects[new..=new], ITERATIONS.0);
        let iterations = new.map_or(ITERATIONS.0, of_new);
        let refined = refine(self.quick, &one.state, iterations);
        let Some(new) = new.filter(|_| self.problem.has_calibration()) else { return refined };
        let rescoped = refine(self.quick, &one.state.rescoped(new), iterations);
        let loss = |state: &State| cross_validate(self.quick, state).map_or(f64::INFINITY, |losses| sum(&losses));
        if loss(&rescoped) < loss(&refined) { rescoped } else { refined }
    }

    /// Returns the refined candidate, then with its form chosen again, where each predicts better; errors are those of the full model.
    pub(super) fn refined(&self, one: &Tried) -> Tried {
        let refined = self.scoped(one);
        let (chosen, chosen_losses) = nuisance::choose(self.problem, &refined, self.criteria);
        let as_refined = cross_validate(self.problem, &refined);
        let as_scanned = cross_validate(self.problem, &one.state);
        let options = [(as_scanned, one.state.clone()), (as_refined, refined), (Some(chosen_losses), chosen)];
        let worst = Tried { score: f64::INFINITY, is_refined: true, ..one.clone() };
        options.into_iter().fold(worst, |best, (losses, state)| match losses {
            Some(losses) if self.score(&losses, &state) < best.score => {
                Tried { score: self.score(&losses, &state), state, losses, ..best }
            }
            _ => best,
        })
    }
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::problem::Problem;
    use crate::search::criteria::Criteria;
    use crate::search::scan::sum;

    /// Oracle: by hand. A lag that hardly differs predicts as well and has the same candidates; a lag of twice that time does not.
    #[test]
    fn sets_that_predict_alike_share_their_candidates() {
        let rig = bench::rig(&["q"], &["c"], &["y"]);
        let course = |rate: f64| -> Vec<f64> { bench::time().iter().map(|t| (rate * t).sin()).collect() };
        let (q, c) = (course(1.7), course(0.6));
        let record = Record::new(bench::time(), vec![q.clone()], vec![c.clone()], vec![]);
        let lag = |time: f64| bench::placed("actuator_lag", Carrier::Rig, &rig, &[time]);
        let mut late = vec![q];
        lag(0.2).instance.act(&[0.2], &record, &mut late);
        let mut noise = bench::noise(0.1);
        let y = late[0].iter().zip(&c).map(|(q, c)| q + 0.3 * c + noise()).collect();
        let series = [bench::series(record, y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let library = [bench::placed("context_term", Carrier::Context(0), &rig, &[1.0]).instance];
        let criteria = Criteria::default();
        let mut search = Search::plain(&problem, &library, &criteria);
        let bare = State::bare(Form::LINEAR);
        search.first = sum(&cross_validate(&problem, &bare).unwrap());
        for (time, expansions) in [(0.2, 1), (0.2001, 1), (0.4, 2)] {
            let tried = search.expand(&bare.with(lag(time)));
            assert_eq!((tried[0].label.as_str(), search.expanded.len()), ("context_term(c)", expansions), "{time}");
        }
    }
}
