//! State of a search: its trials and criteria, the score J, and cached results.

use std::collections::HashMap;

use acm_core::effects::instance::Instance;

use super::candidates::price;
use super::criteria::Criteria;
use super::scan::{Losses, sum};
use super::step::Step;
use super::tried::Expansion;
use crate::fit::problem::Problem;
use crate::fit::state::{Placed, State};

/// Score J, the state, its losses.
pub type Scored = (f64, State, Losses);

/// Smallest fall of J for a set to take the place of another.
pub(super) const LEAST_FALL: f64 = 0.005;

/// Trials of a search.
#[derive(Debug, Clone, Copy)]
pub struct Trials<'p, 'a> {
    /// Trials as they are.
    pub problem: &'p Problem<'a>,
    /// The same trials with fewer samples, for scoring many candidates.
    pub quick: &'p Problem<'a>,
}

/// An effect that chance or a static map may explain.
#[derive(Debug, Clone)]
pub struct Unproven {
    /// Its name, with carrier and signal.
    pub label: String,
    /// The set without it.
    pub without: State,
    /// Losses of that set.
    pub losses: Losses,
    /// Relative reduction of the cross-validated mean square by the effect.
    pub gain: f64,
    /// Whether a static map predicts as well.
    pub is_imitated: bool,
}

/// State of a search; see the head of this file.
pub struct Search<'p, 'a> {
    /// Trials.
    pub problem: &'p Problem<'a>,
    /// Trials with fewer samples.
    pub quick: &'p Problem<'a>,
    /// Effects that may be found.
    pub library: &'p [Instance],
    /// Criteria for accepting an effect.
    pub criteria: &'p Criteria,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Whether the clock may be corrected.
    pub clock: bool,
    pub(crate) first: f64,
    pub(super) expanded: HashMap<Key, Expansion>,
    /// J and keys of the expanded sets of the same effects.
    pub(super) of_labels: HashMap<Vec<String>, Vec<(f64, Key)>>,
    pub(super) thresholds: HashMap<Key, f64>,
    pub(super) rivals: HashMap<Key, f64>,
    pub(super) smoothed: HashMap<Key, f64>,
    pub(super) known: HashMap<Key, Scored>,
    /// Sets whose last effect chance or a static map may explain.
    pub(super) unproven: HashMap<Key, Unproven>,
    /// Whether effects are exchanged; not where a set that was found before predicts these trials about as well.
    pub(super) exchanges: bool,
    pub(super) steps: Vec<Step>,
}

impl<'p, 'a> Search<'p, 'a> {
    /// Returns a search before its first step.
    pub fn new(
        Trials { problem, quick }: Trials<'p, 'a>,
        library: &'p [Instance],
        criteria: &'p Criteria,
        seed: u64,
        clock: bool,
    ) -> Self {
        let (expanded, of_labels, thresholds, rivals, smoothed, known, unproven) = Default::default();
        Self {
            problem,
            quick,
            library,
            criteria,
            seed,
            clock,
            first: f64::NAN,
            expanded,
            of_labels,
            thresholds,
            rivals,
            smoothed,
            known,
            unproven,
            exchanges: true,
            steps: vec![],
        }
    }

    /// Returns a search on the same samples throughout, without a clock correction.
    #[cfg(test)]
    pub fn plain(problem: &'p Problem<'a>, library: &'p [Instance], criteria: &'p Criteria) -> Self {
        Self::new(Trials { problem, quick: problem }, library, criteria, 1, false)
    }

    /// Returns a search on other trials before its first step, with the same J.
    pub fn on<'o>(&self, problem: &'o Problem<'a>) -> Search<'o, 'a>
    where
        'p: 'o,
    {
        let trials = Trials { problem, quick: problem };
        let search = Search::new(trials, self.library, self.criteria, self.seed, self.clock);
        Search { first: self.first, ..search }
    }

    /// Returns the score J of a state.
    pub fn score(&self, losses: &Losses, state: &State) -> f64 {
        self.score_of(sum(losses), state)
    }

    /// Returns J of a state with this sum of squares.
    pub(super) fn score_of(&self, loss: f64, state: &State) -> f64 {
        self.log_error(loss) + price(self.problem, state, self.criteria)
    }

    /// Computes ln(CV / CV₀ + ε).
    pub fn log_error(&self, loss: f64) -> f64 {
        (loss / self.first + self.criteria.negligible).ln()
    }

    /// Returns the root mean square of the weighted outputs together.
    pub fn rms(&self, losses: &Losses) -> f64 {
        (sum(losses) / self.problem.rows().max(1) as f64).sqrt()
    }
}

/// Identity of a state for cached results: labels, values, form.
pub(super) type Key = String;

/// Returns the identity of a state: labels, values, form.
pub(super) fn key(state: &State, problem: &Problem) -> Key {
    let of = |placed: &Placed| format!("{} {:?} {}", placed.label(problem.rig), placed.theta, placed.in_calibration);
    let effects: Vec<String> = state.effects.iter().map(|placed| of(placed)).collect();
    format!("{:?} {} {}", state.form, state.clock, effects.join(" "))
}
