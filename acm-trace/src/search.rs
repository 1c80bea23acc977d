//! One round of the search: which of many changes of the set of effects predicts blocks left out best.
//!
//! 1. Every candidate is fitted from every start with the model linear in its actuators (two steps), and ranked.
//! 2. The best are fitted with the true model, and scored on blocks left out.
//! 3. [`crate::rules`] say whether the best is good enough, and what is as good.

use rayon::prelude::*;

use crate::descent::Descent;
use crate::evaluate::Tip;
use crate::fit::{Scored, score};
use crate::moves::Move;
use crate::rules::is_general_map;
use crate::setup::Setup;

/// A fitted candidate.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Indices of what is new in it.
    pub new: Vec<usize>,
    /// Fit and scores.
    pub scored: Scored,
}

impl Tried {
    /// Whether a value of what is new rests on a bound of what its effect admits.
    pub fn rests_on_bound(&self) -> bool {
        self.new.iter().any(|&i| self.scored.fit.rests_on_bound_at(i))
    }
}

/// Candidates of one round, best first.
#[derive(Debug, Clone)]
pub struct Round {
    /// All that were fitted with the true model.
    pub tried: Vec<Tried>,
}

/// Steps of a fit with the true model.
const STEPS: usize = 12;

/// Candidates that are fitted with the true model: at least, at most.
const FITTED: (usize, usize) = (5, 10);

/// Ranks all moves and fits the best.
pub fn round(setup: &Setup, current: &Scored, moves: Vec<Move>) -> Round {
    let moves: Vec<Move> = moves.into_iter().filter(|change| !is_general_map(&change.instances)).collect();
    let ranked: Vec<(f64, Vec<Vec<Vec<f64>>>)> =
        moves.par_iter().map(|change| screen(setup, current, change)).collect();
    let mut order: Vec<usize> = (0..moves.len()).filter(|&k| ranked[k].0.is_finite()).collect();
    order.sort_by(|&a, &b| ranked[a].0.total_cmp(&ranked[b].0));
    let start = current.fit.cost;
    let best = order.first().map_or(0.0, |&k| (start - ranked[k].0).max(0.0));
    let promising = order.iter().filter(|&&k| start - ranked[k].0 > 0.5 * best).count();
    order.truncate(promising.clamp(FITTED.0, FITTED.1));
    let mut tried: Vec<Tried> = order
        .par_iter()
        .map(|&k| {
            let (instances, delta) = (&moves[k].instances, &current.fit.delta);
            let descents =
                ranked[k].1.iter().map(|theta| Descent::new(instances, theta, delta, Tip::Exact).steps(setup, STEPS));
            let best = descents.reduce(|best, next| if next.cost() < best.cost() { next } else { best });
            best.map(|best| Tried { new: moves[k].new.clone(), scored: score(setup, best.end(setup), Tip::Exact) })
        })
        .flatten()
        .collect();
    // What is added to others and rests on a bound patches what they leave.
    let patches = |tried: &Tried| !current.fit.instances.is_empty() && tried.rests_on_bound();
    tried.retain(|tried| !patches(tried));
    tried.sort_by(|a, b| a.scored.mean_square().total_cmp(&b.scored.mean_square()));
    Round { tried }
}

/// Starts that are fitted, of many.
const STARTS: usize = 3;

/// The starts from which one step leads lowest, moved there; all of few as they are.
fn promising(setup: &Setup, current: &Scored, change: &Move) -> Vec<Vec<Vec<f64>>> {
    if change.starts.len() <= STARTS {
        return change.starts.clone();
    }
    let mut ends: Vec<Descent> =
        change.starts.par_iter().map(|start| descent(setup, current, change, start, 1)).collect();
    ends.retain(|end| end.cost().is_finite());
    ends.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    ends.iter().take(STARTS).map(|end| end.theta().to_vec()).collect()
}

/// Cost of the best start after two linear steps, and the starts worth a true fit.
fn screen(setup: &Setup, current: &Scored, change: &Move) -> (f64, Vec<Vec<Vec<f64>>>) {
    let starts = promising(setup, current, change);
    let mut ends: Vec<Descent> = starts.iter().map(|start| descent(setup, current, change, start, 2)).collect();
    ends.retain(|end| end.cost().is_finite());
    ends.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    let Some(best) = ends.first().map(Descent::cost) else { return (f64::INFINITY, vec![]) };
    (best, ends.iter().take(2).filter(|end| end.cost() < 1.02 * best).map(|end| end.theta().to_vec()).collect())
}

/// Linear steps of a candidate.
fn descent(setup: &Setup, current: &Scored, change: &Move, start: &[Vec<f64>], steps: usize) -> Descent {
    Descent::new(&change.instances, start, &current.fit.delta, Tip::Linear).steps(setup, steps)
}
