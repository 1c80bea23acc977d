//! The search itself: a beam of sets that grow, then drops and exchanges until nothing wins.

use std::collections::HashMap;

use acm_core::effects::instance::Instance;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::candidates::{Candidate, candidates, price};
use super::criteria::Criteria;
use super::nuisance;
use super::scan::{Losses, Scanned, cross_validate, scan};
use super::surrogate::{quantile_of_maximum, sets};
use crate::fit::problem::Problem;
use crate::fit::refine::{project, refine};
use crate::fit::state::{Part, Placed, State};

/// A candidate with its errors.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Name with carrier and signal.
    pub label: String,
    /// With the effect.
    pub state: State,
    /// J.
    pub score: f64,
    /// Sum of squares of each block left out.
    pub losses: Losses,
}

/// One expansion of a state: every candidate, best first.
pub type Expansion = Vec<Tried>;

/// A step of the search, for the report.
#[derive(Debug, Clone)]
pub struct Step {
    /// The set before it.
    pub on: Vec<String>,
    /// What was added, dropped or exchanged.
    pub change: String,
    /// Share of the cross-validated mean square that is gone.
    pub gain: f64,
    /// Quantile of the largest gain on surrogates.
    pub by_chance: Option<f64>,
    /// Mean gain over blocks in standard errors.
    pub t: f64,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Root mean square error left out, after it.
    pub error: f64,
    /// Candidates and their errors, best first.
    pub candidates: Vec<(String, f64)>,
}

/// The result of a search.
#[derive(Debug, Clone)]
pub struct Selected {
    /// The nominal form alone, degree and ridge chosen.
    pub bare: State,
    /// Its losses.
    pub bare_losses: Losses,
    /// With effects.
    pub last: State,
    /// Its losses.
    pub last_losses: Losses,
    /// On the way.
    pub steps: Vec<Step>,
}

/// See the head of this file.
pub struct Search<'p, 'a> {
    /// Trials.
    pub problem: &'p Problem<'a>,
    /// Effects that may be found.
    pub library: &'p [Instance],
    /// When an effect counts.
    pub criteria: &'p Criteria,
    /// Of everything that is drawn.
    pub seed: u64,
    /// Whether the clock may be corrected.
    pub clock: bool,
    first: f64,
    expanded: HashMap<Key, Expansion>,
    thresholds: HashMap<Key, f64>,
    known: HashMap<Key, Scored>,
    steps: Vec<Step>,
}

/// What a state is, for what was computed before: labels, values, form.
type Key = String;

/// Candidates that the search looks at in detail after a scan.
const LISTED: usize = 12;

/// Values to begin with of a candidate on surrogates, at most.
const GUESSES: (usize, usize) = (usize::MAX, 6);

/// Steps of a refinement of one candidate, and of a set.
const ITERATIONS: (usize, usize) = (5, 4);

/// Fall of J for a set to be dropped or exchanged.
const LEAST_FALL: f64 = 0.005;

/// Rounds of drops and exchanges at most.
const ROUNDS: usize = 4;

impl<'p, 'a> Search<'p, 'a> {
    /// Before the first step.
    pub fn new(
        problem: &'p Problem<'a>,
        library: &'p [Instance],
        criteria: &'p Criteria,
        seed: u64,
        clock: bool,
    ) -> Self {
        let (expanded, thresholds, known) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { problem, library, criteria, seed, clock, first: f64::NAN, expanded, thresholds, known, steps: vec![] }
    }

    /// Searches from a nominal form.
    pub fn run(mut self, start: State, mut progress: impl FnMut(&Step)) -> (Selected, Self) {
        let (bare, bare_losses) = nuisance::choose(self.problem, &start, self.criteria);
        self.first = sum(&bare_losses);
        let mut told = 0;
        let mut tell = |steps: &[Step]| {
            steps[told..].iter().for_each(&mut progress);
            told = steps.len();
        };
        let mut beam = vec![(self.score(&bare_losses, &bare), bare.clone(), bare_losses.clone())];
        let mut done = vec![];
        for _ in 0..self.criteria.max_effects {
            let next = self.grow(&beam, &mut done);
            tell(&self.steps);
            if next.is_empty() {
                beam.clear();
                break;
            }
            beam = next;
        }
        done.extend(beam);
        let last = done.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let last = self.settle(last.unwrap_or((0.0, bare.clone(), bare_losses.clone())));
        tell(&self.steps);
        let steps = self.steps.clone();
        (Selected { bare, bare_losses, last: last.1, last_losses: last.2, steps }, self)
    }

    /// Drops, exchanges and grows until nothing changes.
    fn settle(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            let before = last.1.labels(self.problem.rig);
            last = self.tidy(last);
            last = self.grow_once(last);
            if last.1.labels(self.problem.rig) == before {
                break;
            }
        }
        last
    }

    /// J.
    pub fn score(&self, losses: &Losses, state: &State) -> f64 {
        self.log_error(sum(losses)) + price(self.problem, state, self.criteria)
    }

    /// ln(CV / CV₀ + ε).
    pub fn log_error(&self, loss: f64) -> f64 {
        (loss / self.first + self.criteria.negligible).ln()
    }

    /// Every set of the beam with each of its best candidates that passes.
    fn grow(&mut self, beam: &[Scored], done: &mut Vec<Scored>) -> Vec<Scored> {
        let mut next: Vec<Scored> = Vec::new();
        for (score, state, losses) in beam {
            let tried = self.expand(state);
            let mut grown = false;
            for (rank, candidate) in tried.iter().take(self.criteria.beam).enumerate() {
                if !self.passes(state, losses, candidate, &tried, rank == 0) {
                    continue;
                }
                grown = true;
                let labels = candidate.state.labels(self.problem.rig);
                match next.iter_mut().find(|(_, old, _)| old.labels(self.problem.rig) == labels) {
                    Some(old) if candidate.score < old.0 => {
                        *old = (candidate.score, candidate.state.clone(), candidate.losses.clone());
                    }
                    Some(_) => (),
                    None => next.push((candidate.score, candidate.state.clone(), candidate.losses.clone())),
                }
            }
            if !grown {
                done.push((*score, state.clone(), losses.clone()));
            }
        }
        next.sort_by(|a, b| a.0.total_cmp(&b.0));
        next.truncate(self.criteria.beam);
        next
    }

    fn grow_once(&mut self, last: Scored) -> Scored {
        let size = last.1.effects.len() + usize::from(last.1.clock != 0.0);
        if size == 0 || size >= self.criteria.max_effects {
            return last;
        }
        let tried = self.expand(&last.1);
        match tried.first() {
            Some(best) if self.passes(&last.1, &last.2, best, &tried, true) => {
                (best.score, best.state.clone(), best.losses.clone())
            }
            _ => last,
        }
    }

    /// Drops and exchanges while J falls.
    fn tidy(&mut self, mut last: Scored) -> Scored {
        for _ in 0..ROUNDS {
            let mut best: Option<(Scored, String)> = None;
            let bar = |best: &Option<(Scored, String)>| best.as_ref().map_or(last.0 - LEAST_FALL, |best| best.0.0);
            for (name, without) in self.smaller(&last.1) {
                let rest = self.settled(&without);
                if rest.0 < bar(&best) {
                    best = Some((rest.clone(), format!("− {name}")));
                }
                if last.1.effects.len() < 2 {
                    continue;
                }
                let tried = self.expand(&rest.1);
                for candidate in tried.iter().take(2) {
                    if candidate.label != name
                        && candidate.score < bar(&best)
                        && self.passes(&rest.1, &rest.2, candidate, &tried, false)
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

    /// The state without each of its effects, or without its clock correction.
    pub fn smaller(&self, state: &State) -> Vec<(String, State)> {
        let mut all: Vec<(String, State)> =
            state.effects.iter().enumerate().map(|(i, e)| (e.label(self.problem.rig), state.without(i))).collect();
        if state.clock != 0.0 {
            all.push((super::candidates::CLOCK.into(), State { clock: 0.0, ..state.clone() }));
        }
        all
    }

    /// A state with its values refined and its form chosen again.
    pub fn settled(&mut self, state: &State) -> Scored {
        let key = key(state, self.problem);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let refined = refine(self.problem, state, ITERATIONS.1);
        let (chosen, losses) = nuisance::choose(self.problem, &refined, self.criteria);
        let settled = (self.score(&losses, &chosen), chosen, losses);
        self.known.insert(key, settled.clone());
        settled
    }

    /// All candidates on a state; the best are refined together with the rest.
    pub fn expand(&mut self, state: &State) -> Expansion {
        let key = key(state, self.problem);
        if let Some(known) = self.expanded.get(&key) {
            return known.clone();
        }
        let all = candidates(self.problem, state, self.library, self.clock);
        let beta = project(self.problem, state)
            .map_or_else(|| DMatrix::zeros(0, self.problem.outputs()), |fitted| fitted.beta);
        let scanned = scan(self.problem, &all, &beta, None, GUESSES.0);
        let mut tried: Vec<Tried> =
            all.iter().zip(scanned).filter_map(|(candidate, scanned)| self.tried(candidate, scanned?)).collect();
        tried.sort_by(|a, b| a.score.total_cmp(&b.score));
        let refined = self.criteria.refined.min(tried.len());
        let better: Vec<Tried> = tried[..refined].par_iter().map(|one| self.refined(one)).collect();
        tried.splice(..refined, better);
        tried.sort_by(|a, b| a.score.total_cmp(&b.score));
        self.expanded.insert(key, tried.clone());
        tried
    }

    fn tried(&self, candidate: &Candidate, scanned: Scanned) -> Option<Tried> {
        let state = candidate.states[scanned.best].clone();
        let losses = scanned.losses.into_iter().next()?;
        Some(Tried { label: candidate.label.clone(), score: self.score(&losses, &state), state, losses })
    }

    /// Refined, then with its form chosen again, where each predicts better; the errors are those of the true model.
    fn refined(&self, one: &Tried) -> Tried {
        let refined = refine(self.problem, &one.state, ITERATIONS.0);
        let (chosen, chosen_losses) = nuisance::choose(self.problem, &refined, self.criteria);
        let as_refined = cross_validate(self.problem, &refined);
        let as_scanned = cross_validate(self.problem, &one.state);
        let options = [(as_scanned, one.state.clone()), (as_refined, refined), (Some(chosen_losses), chosen)];
        let worst = Tried { score: f64::INFINITY, ..one.clone() };
        options.into_iter().fold(worst, |best, (losses, state)| match losses {
            Some(losses) if self.score(&losses, &state) < best.score => {
                Tried { score: self.score(&losses, &state), state, losses, label: one.label.clone() }
            }
            _ => best,
        })
    }

    /// Practical size, paired t over blocks, and the largest gain on surrogates.
    fn passes(&mut self, state: &State, losses: &Losses, candidate: &Tried, tried: &[Tried], note: bool) -> bool {
        let gain = 1.0 - sum(&candidate.losses) / sum(losses);
        let t = paired_t(losses, &candidate.losses);
        let mut ok = candidate.score < self.score(losses, state)
            && t > self.criteria.least_t
            && !rests_on_bound(&candidate.state);
        let mut by_chance = None;
        if ok {
            let threshold = self.threshold(state, candidate);
            by_chance = Some(threshold);
            ok = gain > threshold;
        }
        if note {
            let candidates = tried.iter().take(LISTED).map(|t| (t.label.clone(), self.rms(&t.losses))).collect();
            self.steps.push(Step {
                on: state.labels(self.problem.rig),
                change: format!("+ {}", candidate.label),
                gain,
                by_chance,
                t,
                accepted: ok,
                error: self.rms(&candidate.losses),
                candidates,
            });
        }
        ok
    }

    fn note(&mut self, state: &State, before: &Losses, change: &str, after: &Losses) {
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

    /// Root mean square of the weighted outputs together.
    pub fn rms(&self, losses: &Losses) -> f64 {
        (sum(losses) / self.problem.rows().max(1) as f64).sqrt()
    }

    /// Quantile of the largest gain of any candidate where what the larger model leaves is put on the fit of the smaller one.
    fn threshold(&mut self, state: &State, larger: &Tried) -> f64 {
        let key = key(state, self.problem);
        if let Some(known) = self.thresholds.get(&key) {
            return *known;
        }
        let value = self.largest_by_chance(state, larger).unwrap_or(f64::INFINITY);
        self.thresholds.insert(key, value);
        value
    }

    fn largest_by_chance(&self, state: &State, larger: &Tried) -> Option<f64> {
        let (small, large) = (project(self.problem, state)?, project(self.problem, &larger.state)?);
        let width = small.residual.ncols();
        let edges = self.problem.edges();
        // What is added to the targets takes the residual of the smaller model away and puts the surrogate in its place.
        let count = self.criteria.surrogates;
        let mut added = sets(&large.residual, &edges, count, self.seed);
        added.column_iter_mut().enumerate().for_each(|(c, mut column)| column -= small.residual.column(c % width));
        let all = candidates(self.problem, state, self.library, self.clock);
        let scanned = scan(self.problem, &all, &small.beta, Some(&added), GUESSES.1);
        let same = Candidate { label: String::new(), new: None, states: vec![state.clone()] };
        let base = scan(self.problem, &[same], &small.beta, Some(&added), 1).into_iter().next()??;
        let largest: Vec<f64> = (0..count)
            .map(|set| {
                let before = sum(&base.losses[set]);
                let gains = scanned.iter().flatten().map(|scanned| 1.0 - sum(&scanned.losses[set]) / before);
                gains.fold(f64::NEG_INFINITY, f64::max)
            })
            .collect();
        Some(quantile_of_maximum(&largest, self.criteria.family_wise))
    }
}

/// J, the state, its losses.
pub type Scored = (f64, State, Losses);

/// Sum over blocks.
pub fn sum(losses: &[f64]) -> f64 {
    losses.iter().sum()
}

/// Mean fall over blocks in its standard errors: of the sums of squares, or of their logarithms where blocks differ in size.
pub fn paired_t(before: &[f64], after: &[f64]) -> f64 {
    let pairs = || before.iter().zip(after);
    let absolute = t_of(pairs().map(|(before, after)| before - after).collect());
    let floor = f64::MIN_POSITIVE;
    let relative = t_of(pairs().map(|(before, after)| (before.max(floor) / after.max(floor)).ln()).collect());
    absolute.max(relative)
}

fn t_of(falls: Vec<f64>) -> f64 {
    let n = falls.len() as f64;
    let mean = falls.iter().sum::<f64>() / n;
    let variance = falls.iter().map(|fall| (fall - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    mean / (variance / n).sqrt().max(f64::MIN_POSITIVE)
}

/// Whether a value of an effect with memory rests on a bound of what it admits: a time on the longest that the trials tell, or
/// any value where other effects act already. It stands for something else.
pub fn rests_on_bound(state: &State) -> bool {
    let lasting = |placed: &&std::sync::Arc<Placed>| matches!(placed.part(), Part::Input | Part::Filter);
    let others = state.effects.len() > 1;
    state.effects.iter().filter(lasting).any(|placed| {
        let specs = placed.instance.parameters().iter().zip(&placed.theta);
        specs.filter(|(spec, _)| spec.is_free()).any(|(spec, value)| {
            spec.unit == "s" && *value > LONGEST * spec.upper || others && spec.is_at_bound(*value)
        })
    })
}

/// Share of the longest time at which a value rests on it.
const LONGEST: f64 = 0.99;

fn key(state: &State, problem: &Problem) -> Key {
    let form = format!("{:?} {}", state.form, state.in_calibration);
    let effects: Vec<String> =
        state.effects.iter().map(|placed| format!("{} {:?}", placed.label(problem.rig), placed.theta)).collect();
    format!("{form} {} {}", state.clock, effects.join(" "))
}
