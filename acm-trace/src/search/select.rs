//! Beam search over growing sets of effects. The best of them is settled ([`settle`](super::settle)).

mod pairs;

use acm_core::rig::Rig;

use super::accept::{Tested, paired_t, rests_on_bound};
use super::nuisance;
use super::scan::Losses;
use super::scored::{LEAST_FALL, key};
use super::tried::Tried;
use crate::fit::state::State;

pub use super::scan::sum;
pub use super::scored::{Scored, Search, Trials, Unproven};
pub use super::step::Step;

/// The result of a search.
#[derive(Debug, Clone)]
pub struct Selected {
    /// The nominal form alone, degree and ridge chosen.
    pub bare: State,
    /// Losses of the model without effects.
    pub bare_losses: Losses,
    /// State with effects, before its values are refined on all samples, and its losses.
    pub settled: (State, Losses),
    /// State with effects.
    pub last: State,
    /// Losses of the state with effects.
    pub last_losses: Losses,
}

impl Selected {
    /// Returns the result with another set in its place.
    pub(super) fn with(self, (_, state, losses): Scored) -> Self {
        Self { settled: (state.clone(), losses.clone()), last: state, last_losses: losses, ..self }
    }
}

/// A set that was found on another version of the trials.
#[derive(Debug, Clone, Copy)]
pub struct Found<'s> {
    /// The set.
    pub state: &'s State,
    /// Its losses on those trials, if comparable with losses on these.
    pub losses: Option<&'s Losses>,
}

impl Search<'_, '_> {
    /// Searches from a nominal form, or on from a set that was found before.
    pub fn run(&mut self, start: &State, found: Option<Found>, mut progress: impl FnMut(&Step)) -> Selected {
        let (bare, bare_losses) = nuisance::choose(self.problem, start, self.criteria);
        self.first = sum(&bare_losses);
        let mut told = 0;
        let mut tell = |steps: &[Step]| {
            steps[told..].iter().for_each(&mut progress);
            told = steps.len();
        };
        let first = (self.score(&bare_losses, &bare), bare.clone(), bare_losses.clone());
        let (mut beam, mut done) = match found {
            None => (vec![first], vec![]),
            Some(found) => (vec![self.found_again(found)], vec![first]),
        };
        for _ in 0..self.criteria.max_effects {
            let next = self.grow(&beam, &mut done);
            tell(&self.steps);
            if next.is_empty() {
                beam.clear();
                break;
            }
            beam = next;
        }
        done.extend(beam.into_iter().filter(|one| !self.unproven.contains_key(&key(&one.1, self.problem))));
        let last = done.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let mut settled = self.settle(last.unwrap_or((0.0, bare.clone(), bare_losses.clone())));
        if let Some(bent) = self.bent(&settled) {
            settled = self.settle(bent);
        }
        tell(&self.steps);
        let (_, last, last_losses) = self.polished(settled.clone());
        Selected { bare, bare_losses, settled: (settled.1, settled.2), last, last_losses }
    }

    /// Returns a set that was found before with its values refined. Its effects are exchanged for others where J falls by a price or more.
    fn found_again(&mut self, found: Found) -> Scored {
        let settled = self.settled(found.state);
        let change = found.losses.map(|losses| settled.0 - self.score(losses, found.state));
        self.exchanges = change.is_none_or(|change| change <= -self.criteria.price);
        settled
    }

    /// Extends every set of the beam by each of its best candidates that passes; of sets that differ in what sizes depend on, the best is
    /// kept. A first effect that chance may explain is extended too, since another cause may mask it. So is an effect that a static map
    /// imitates. Both are tested again beside a second effect.
    fn grow(&mut self, beam: &[Scored], done: &mut Vec<Scored>) -> Vec<Scored> {
        let mut next: Vec<Scored> = Vec::new();
        for (score, state, losses) in beam {
            let tried = self.expand(state);
            let unproven = self.unproven.get(&key(state, self.problem)).cloned();
            let (mut grown, mut is_proven): (Vec<Vec<String>>, bool) = (vec![], false);
            for (rank, candidate) in possible(&tried, self.problem.rig).enumerate() {
                if grown.len() == self.criteria.beam {
                    break;
                }
                // The first of a kind that passed is the best: the same effects in another form would only take its place.
                let kinds = candidate.state.kinds(self.problem.rig);
                if grown.contains(&kinds) {
                    continue;
                }
                match (self.tested(state, losses, candidate, &tried, rank == 0), &unproven) {
                    (Tested::Passed, None) => is_proven = true,
                    (Tested::Passed, Some(first)) if self.proves(first, candidate) => (),
                    (Tested::Unproven { gain, is_imitated }, None) if is_imitated || state.effects.is_empty() => {
                        let (label, without, losses) = (candidate.label.clone(), state.clone(), losses.clone());
                        let first = Unproven { label, without, losses, gain, is_imitated };
                        self.unproven.insert(key(&candidate.state, self.problem), first);
                    }
                    _ => continue,
                }
                grown.push(kinds.clone());
                match next.iter_mut().find(|(_, old, _)| old.kinds(self.problem.rig) == kinds) {
                    Some(old) if candidate.score < old.0 => {
                        *old = candidate.scored();
                    }
                    Some(_) => (),
                    None => next.push(candidate.scored()),
                }
            }
            if !is_proven && unproven.is_none() {
                done.push((*score, state.clone(), losses.clone()));
            }
        }
        next.sort_by(|a, b| a.0.total_cmp(&b.0));
        next.truncate(self.criteria.beam);
        let best = next.first().map_or(0.0, |best| best.0);
        next.retain(|one| one.0 < best + self.criteria.behind);
        next
    }

    /// Compares the results of two searches of the same outputs, accepted where J falls.
    pub fn compared(&self, change: &str, from: &Selected, to: &Selected) -> Step {
        let score = |selected: &Selected| self.score(&selected.last_losses, &selected.last);
        let accepted = score(to) < score(from) - LEAST_FALL;
        Step { accepted, ..self.step(&from.last, &from.last_losses, change, &to.last_losses) }
    }

    pub(super) fn note(&mut self, state: &State, before: &Losses, change: &str, after: &Losses) {
        self.steps.push(self.step(state, before, change, after));
    }

    fn step(&self, state: &State, before: &Losses, change: &str, after: &Losses) -> Step {
        Step {
            on: state.labels(self.problem.rig),
            change: change.into(),
            gain: 1.0 - sum(after) / sum(before),
            by_chance: None,
            t: paired_t(before, after),
            accepted: true,
            error: self.rms(after),
            candidates: vec![],
        }
    }
}

/// Returns the candidates that were refined and do not stand for something else.
pub(super) fn possible<'t>(tried: &'t [Tried], rig: &Rig) -> impl Iterator<Item = &'t Tried> {
    tried.iter().filter(move |one| one.is_refined && !rests_on_bound(one, rig))
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

    /// Oracle: c moves in two or three of twelve trials, d a third as far in all, y = c + d beside noise. A gain in 2 of 12 blocks has
    /// t = 1.5, and Student's t of 11 degrees of freedom exceeds 1.8 once in twenty: c by itself may be chance. Beside it d gains in every
    /// block, and both together do. Where d is no part of y, c remains chance. A gain in 3 of 12 blocks has t = 1.9, and is many times
    /// what chance gains here.
    #[test]
    fn a_first_effect_that_gains_in_few_blocks_is_proven_beside_a_second() {
        let rig = bench::rig(&["q"], &["c", "d"], &["y"]);
        let time: Vec<f64> = bench::time().into_iter().take(400).collect();
        let mut noise = bench::noise(0.3);
        let mut found = |moving: u32, share: f64| {
            let series: Vec<_> = (0..12)
                .map(|trial| {
                    let course = |size: f64, rate: f64| -> Vec<f64> {
                        time.iter().map(|t| size * (rate * t + f64::from(trial)).sin()).collect()
                    };
                    let (c, d) = (course(if trial < moving { 1.0 } else { 0.0 }, 3.0), course(0.3, 5.0));
                    let y = c.iter().zip(&d).map(|(c, d)| c + share * d + noise()).collect();
                    bench::series(Record::new(time.clone(), vec![vec![0.0; 400]], vec![c, d], vec![]), y)
                })
                .collect();
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let library = [0, 1].map(|c| bench::placed("context_term", Carrier::Context(c), &rig, &[1.0]).instance);
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &library, &criteria);
            let bare = State::bare(Form { degree: Some(0), ..Form::LINEAR });
            search.run(&bare, None, |_| ()).last.labels(&rig)
        };
        assert_eq!(found(2, 1.0), ["context_term(c)", "context_term(d)"]);
        assert_eq!(found(2, 0.0), Vec::<String>::new());
        assert_eq!(found(3, 0.0), ["context_term(c)"]);
    }

    /// Oracle: by hand. A set that predicts other trials as it did the first keeps its effects, and only sets with one more are looked
    /// at; where its error is no guide, or half of what it was, both of its effects are exchanged too.
    #[test]
    fn a_set_that_predicts_as_before_keeps_its_effects() {
        let rig = bench::rig(&["q"], &["c", "d", "e"], &["y"]);
        let course = |rate: f64| -> Vec<f64> { bench::time().iter().map(|t| (rate * t).sin()).collect() };
        let (c, d, e) = (course(0.7), course(1.9), course(3.1));
        let mut noise = bench::noise(0.1);
        let y = c.iter().zip(&d).map(|(c, d)| c + d + noise()).collect();
        let still = vec![0.0; c.len()];
        let series = [bench::series(Record::new(bench::time(), vec![still], vec![c, d, e], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let library = [0, 1, 2].map(|c| bench::placed("context_term", Carrier::Context(c), &rig, &[1.0]).instance);
        let criteria = Criteria::default();
        let bare = State::bare(Form { degree: Some(0), ..Form::LINEAR });
        let first = Search::plain(&problem, &library, &criteria).run(&bare, None, |_| ());
        assert_eq!(first.last.labels(&rig), ["context_term(c)", "context_term(d)"]);
        let expanded = |losses: Option<&Losses>| {
            let mut again = Search::plain(&problem, &library, &criteria);
            let found = again.run(&bare, Some(Found { state: &first.last, losses }), |_| ());
            assert_eq!(found.last.labels(&rig), first.last.labels(&rig));
            again.expanded.len()
        };
        let twice: Losses = first.last_losses.iter().map(|loss| 2.0 * loss).collect();
        assert_eq!([Some(&first.last_losses), Some(&twice), None].map(expanded), [1, 3, 3]);
    }

    /// Oracle: y is q beyond a dead zone of 0.25 half ranges, cut off 0.7 on, beside noise. A polynomial takes up most of either corner,
    /// and neither of both together. Where y is a polynomial of q, none has corners.
    #[test]
    fn a_dead_zone_and_a_saturation_are_proven_together() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let time: Vec<f64> = bench::time().into_iter().take(400).collect();
        let library = ["dead_zone", "saturation"].map(|name| bench::placed(name, Carrier::Rig, &rig, &[]).instance);
        let found = |y: &dyn Fn(f64) -> f64| {
            let mut noise = bench::noise(0.02);
            let series: Vec<_> = (0..12)
                .map(|trial| {
                    let q: Vec<f64> = time.iter().map(|t| (1.7 * t + f64::from(trial)).sin()).collect();
                    let y = q.iter().map(|q| y(*q) + noise()).collect();
                    bench::series(Record::new(time.clone(), vec![q], vec![], vec![]), y)
                })
                .collect();
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let criteria = Criteria::default();
            let mut search = Search::plain(&problem, &library, &criteria);
            search.run(&State::bare(Form::LINEAR), None, |_| ()).last.labels(&rig)
        };
        let cornered = |q: f64| (q.abs() - 0.25).clamp(0.0, 0.45).copysign(q);
        assert_eq!(found(&cornered), ["dead_zone", "saturation"]);
        assert_eq!(found(&|q| q - 0.4 * q.powi(3) + 0.1 * q.powi(5)), Vec::<String>::new());
    }
}
