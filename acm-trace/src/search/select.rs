//! The search itself: a beam of sets that grow, then drops and exchanges until none improves J.

use acm_core::rig::Rig;

use super::accept::{Tested, least_t, paired_t, rests_on_bound};
use super::candidates::{plainer, price, steadied};
use super::nuisance;
use super::scan::Losses;
use super::scored::key;
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

/// Smallest fall of J for a set to be dropped or exchanged.
pub(super) const LEAST_FALL: f64 = 0.005;

/// Number of candidates that are tried in the place of an effect.
const EXCHANGED: usize = 2;

/// Largest number of rounds of drops and exchanges.
const ROUNDS: usize = 4;

impl Search<'_, '_> {
    /// Searches from a nominal form, or from a set that was found on these trials with other offsets.
    pub fn run(&mut self, start: &State, found: Option<&State>, mut progress: impl FnMut(&Step)) -> Selected {
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
            Some(found) => (vec![self.settled(found)], vec![first]),
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

    /// Drops, exchanges and adds effects until nothing changes.
    fn settle(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            let before = last.1.labels(self.problem.rig);
            last = self.tidy(last);
            last = self.split(last);
            last = self.grow_once(last);
            if last.1.labels(self.problem.rig) == before {
                break;
            }
        }
        last
    }

    /// Returns a set beside a nominal form with kinks, where that predicts better by as much as an effect has to. Kinks come last: a
    /// saturation or a dead zone has a name, and a map with kinks takes up what it does.
    fn bent(&mut self, last: &Scored) -> Option<Scored> {
        if last.1.effects.is_empty() && last.1.clock == 0.0 {
            return None;
        }
        let mut best = last.clone();
        // Once more with the values that suit the first kinks.
        for _ in 0..2 {
            let (bent, _) = nuisance::bent(self.problem, &best.1, self.criteria)?;
            best = self.settled(&bent);
        }
        let is_better = !best.1.form.kinks.is_empty()
            && best.0 < last.0 - self.criteria.price
            && paired_t(&last.2, &best.2) > least_t(last.2.len(), self.criteria.level)
            && self.is_better_as_saved((best.0, &best.1), (last.0, &last.1));
        if is_better {
            self.note(&last.1, &last.2, &format!("{} kinks of the map", best.1.form.kinks.count()), &best.2);
        }
        is_better.then_some(best)
    }

    /// Extends every set of the beam by each of its best candidates that passes; of sets that differ in what sizes
    /// depend on, the best is kept. A first effect that chance may explain is extended too: what another cause leaves
    /// is chance to it. Beside a second effect it is tested again.
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
                // Of a kind that passed the first is the best: the same effects in another form would only take its place.
                let kinds = candidate.state.kinds(self.problem.rig);
                if grown.contains(&kinds) {
                    continue;
                }
                match (self.tested(state, losses, candidate, &tried, rank == 0), &unproven) {
                    (Tested::Passed, None) => is_proven = true,
                    (Tested::Passed, Some(first)) if self.proves(first, candidate) => (),
                    (Tested::Unproven { gain }, None) if state.effects.is_empty() => {
                        let first = Unproven { without: state.clone(), gain };
                        self.unproven.insert(key(&candidate.state, self.problem), first);
                    }
                    _ => continue,
                }
                grown.push(kinds.clone());
                match next.iter_mut().find(|(_, old, _)| old.kinds(self.problem.rig) == kinds) {
                    Some(old) if candidate.score < old.0 => {
                        *old = (candidate.score, candidate.state.clone(), candidate.losses.clone());
                    }
                    Some(_) => (),
                    None => next.push((candidate.score, candidate.state.clone(), candidate.losses.clone())),
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

    /// Returns whether a first effect is no chance beside a second: it gains more than the best candidate does by chance where both
    /// are.
    fn proves(&self, first: &Unproven, both: &Tried) -> bool {
        first.gain > self.by_chance(&first.without, &both.state)
    }

    fn grow_once(&mut self, last: Scored) -> Scored {
        let size = last.1.effects.len() + usize::from(last.1.clock != 0.0);
        if size == 0 || size >= self.criteria.max_effects {
            return last;
        }
        let tried = self.expand(&last.1);
        let mut ranked = possible(&tried, self.problem.rig).enumerate();
        match ranked.find(|(rank, one)| self.tested(&last.1, &last.2, one, &tried, *rank == 0) == Tested::Passed) {
            Some((_, best)) => (best.score, best.state.clone(), best.losses.clone()),
            None => last,
        }
    }

    /// Drops and exchanges while J falls.
    fn tidy(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            let mut best: Option<(Scored, String)> = None;
            let bar = |best: &Option<(Scored, String)>| best.as_ref().map_or(last.0 - LEAST_FALL, |best| best.0.0);
            for i in 0..last.1.effects.len() {
                let Some((simple, plain)) = plainer(&last.1, i, self.library) else { continue };
                let plain = self.settled(&plain);
                if plain.0 < bar(&best) {
                    best = Some((plain, format!("{} → {simple}", last.1.effects[i].label(self.problem.rig))));
                }
            }
            for (name, without) in self.smaller(&last.1) {
                let rest = self.settled(&without);
                if rest.0 < bar(&best) {
                    best = Some((rest.clone(), format!("− {name}")));
                }
                if last.1.effects.len() < 2 {
                    continue;
                }
                // Beside the others as they are: without the effect they would take over what they can of it.
                let tried = self.expand(&without);
                let others = possible(&tried, self.problem.rig).filter(|candidate| candidate.label != name);
                for candidate in others.take(EXCHANGED) {
                    if candidate.score < bar(&best)
                        && self.may_replace((&last.1, &last.2), candidate)
                        && self.tested(&rest.1, &rest.2, candidate, &tried, false) == Tested::Passed
                    {
                        let found = (candidate.score, candidate.state.clone(), candidate.losses.clone());
                        best = Some((found, format!("{name} → {}", candidate.label)));
                    }
                }
            }
            let Some((next, change)) = best else { return last };
            self.note(&last.1, &last.2, &change, &next.2);
            last = next;
        }
        last
    }

    /// Replaces a size that depends on a signal by a constant one and another effect, where that predicts better: such a size may stand
    /// for two effects.
    fn split(&mut self, last: Scored) -> Scored {
        let mut best: Option<(Scored, String)> = None;
        for i in 0..last.1.effects.len() {
            let Some(steady) = steadied(self.problem, &last.1, i, self.library) else { continue };
            let name = last.1.effects[i].label(self.problem.rig);
            let rest = self.settled(&steady);
            let tried = self.expand(&rest.1);
            for candidate in possible(&tried, self.problem.rig).filter(|one| one.label != name).take(EXCHANGED) {
                let bar = best.as_ref().map_or(last.0 - LEAST_FALL, |best| best.0.0);
                if candidate.score < bar
                    && self.may_replace((&last.1, &last.2), candidate)
                    && self.tested(&rest.1, &rest.2, candidate, &tried, false) == Tested::Passed
                {
                    let found = (candidate.score, candidate.state.clone(), candidate.losses.clone());
                    best = Some((
                        found,
                        format!("{name} → {}, {}", rest.1.effects[i].label(self.problem.rig), candidate.label),
                    ));
                }
            }
        }
        let Some((next, change)) = best else { return last };
        self.note(&last.1, &last.2, &change, &next.2);
        next
    }

    /// Returns whether a set may take the place of another: it costs less, or predicts better in most blocks.
    pub(super) fn may_replace(&self, last: (&State, &Losses), candidate: &Tried) -> bool {
        let of = |state: &State| price(self.problem, state, self.criteria);
        of(&candidate.state) < of(last.0)
            || paired_t(last.1, &candidate.losses) > least_t(last.1.len(), self.criteria.level)
    }

    /// Returns the state without each of its effects, or without its clock correction.
    pub fn smaller(&self, state: &State) -> Vec<(String, State)> {
        let mut all: Vec<(String, State)> =
            state.effects.iter().enumerate().map(|(i, e)| (e.label(self.problem.rig), state.without(i))).collect();
        if state.clock != 0.0 {
            all.push((super::candidates::CLOCK.into(), State { clock: 0.0, ..state.clone() }));
        }
        all
    }

    pub(super) fn note(&mut self, state: &State, before: &Losses, change: &str, after: &Losses) {
        self.steps.push(Step {
            on: state.labels(self.problem.rig),
            change: change.into(),
            gain: 1.0 - sum(after) / sum(before),
            by_chance: None,
            t: paired_t(before, after),
            accepted: true,
            error: self.rms(after),
            candidates: vec![],
        });
    }
}

/// Returns the candidates that were refined and do not stand for something else.
pub(super) fn possible<'t>(tried: &'t [Tried], rig: &Rig) -> impl Iterator<Item = &'t Tried> {
    tried.iter().filter(move |one| one.is_refined && !rests_on_bound(one, rig))
}
