//! Cross-validated errors of candidates. Initial guesses are also chosen without the fold.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::candidates::Candidate;
use crate::fit::design::design;
use crate::fit::gram::{CrossValidated, Grams};
use crate::fit::moved::{carried, tangents};
use crate::fit::problem::Problem;
use crate::fit::refine::slopes;
use crate::fit::state::State;

/// Sum of squares of each block left out.
pub type Losses = Vec<f64>;

/// Returns the sum over blocks.
pub fn sum(losses: &[f64]) -> f64 {
    losses.iter().sum()
}

/// Result of scanning a candidate.
#[derive(Debug, Clone)]
pub struct Scanned {
    /// Sum of squares of each block left out.
    pub losses: Losses,
    /// Index of the initial guess that predicts best.
    pub best: usize,
}

/// Returns the losses of one state; none where its equations are singular.
pub fn cross_validate(problem: &Problem, state: &State) -> Option<Losses> {
    let grams = Grams::new(&design(problem, state), &problem.blocks);
    grams.cross_validate(&problem.blocks, state.form.ridge).map(|cv| cv.loss)
}

/// Scans every candidate, around a solution β of the state without it. The values of the state may move to first order.
pub fn scan(problem: &Problem, small: &State, candidates: &[Candidate], beta: &DMatrix<f64>) -> Vec<Option<Scanned>> {
    let old = slopes(problem, small, beta);
    let around = Around { small, beta, old: &old };
    let work = |of: &dyn Fn(usize, usize) -> bool| -> Vec<(usize, usize)> {
        let each = |(c, candidate): (usize, &Candidate)| (0..candidate.states.len()).map(move |k| (c, k));
        candidates.iter().enumerate().flat_map(each).filter(|&(c, k)| of(c, k)).collect()
    };
    let mut tried: Vec<Vec<(usize, CrossValidated)>> = vec![vec![]; candidates.len()];
    let run = |work: Vec<(usize, usize)>, tried: &mut Vec<Vec<(usize, CrossValidated)>>| {
        let done: Vec<Option<CrossValidated>> =
            work.par_iter().map(|&(c, k)| of_guess(problem, around, &candidates[c], k)).collect();
        work.into_iter().zip(done).for_each(|((c, k), cv)| tried[c].extend(cv.map(|cv| (k, cv))));
    };
    let is_coarse = |c: usize, k: usize| candidates[c].coarse().any(|coarse| coarse == k);
    let is_plain = |c: usize| candidates[c].each.is_none();
    run(work(&|c, k| is_plain(c) && is_coarse(c, k)), &mut tried);
    // Sizes that depend on a signal begin where the plain effect predicts best.
    let shares: Vec<Option<f64>> = candidates.iter().map(|one| best_share(problem, one, candidates, &tried)).collect();
    let is_near = |c: usize, k: usize| match shares[c] {
        Some(share) if !is_plain(c) => candidates[c].next_to(share)(k),
        _ => is_coarse(c, k),
    };
    run(work(&|c, k| !is_plain(c) && is_near(c, k)), &mut tried);
    let promising = best(problem, &tried);
    run(work(&|c, k| promising[c] && !is_near(c, k)), &mut tried);
    tried.iter_mut().for_each(|tried| tried.sort_by_key(|one| one.0));
    tried.iter().map(|tried| chosen(problem, tried)).collect()
}

/// Returns the position of the plain effect's best initial guess in its list, as a share.
fn best_share(
    problem: &Problem,
    of: &Candidate,
    candidates: &[Candidate],
    tried: &[Vec<(usize, CrossValidated)>],
) -> Option<f64> {
    let plain = candidates.iter().position(|one| one.each.is_none() && one.label == of.plain())?;
    let best = chosen(problem, &tried[plain])?.best;
    Some((best as f64 + 0.5) / candidates[plain].states.len() as f64)
}

/// Number of candidates that are tried with all of their initial guesses.
const PROMISING: usize = 24;

/// Returns the candidates with the smallest errors.
fn best(problem: &Problem, tried: &[Vec<(usize, CrossValidated)>]) -> Vec<bool> {
    let total = |tried: &Vec<(usize, CrossValidated)>| {
        chosen(problem, tried).map_or(f64::INFINITY, |scanned| scanned.losses.iter().sum::<f64>())
    };
    let totals: Vec<f64> = tried.iter().map(total).collect();
    let mut order: Vec<usize> = (0..totals.len()).collect();
    order.sort_by(|&a, &b| totals[a].total_cmp(&totals[b]));
    let mut is_best = vec![false; totals.len()];
    order.into_iter().take(PROMISING).for_each(|c| is_best[c] = true);
    is_best
}

/// The state that candidates are added to.
#[derive(Clone, Copy)]
struct Around<'s> {
    small: &'s State,
    /// Coefficients of the state.
    beta: &'s DMatrix<f64>,
    /// Slopes of the outputs with respect to the state's values.
    old: &'s [DMatrix<f64>],
}

/// Scores one initial guess; parameters that have a sign are linear around it.
fn of_guess(problem: &Problem, around: Around, candidate: &Candidate, guess: usize) -> Option<CrossValidated> {
    let state = &candidate.states[guess];
    let mut regression = design(problem, state);
    regression.coupled = around.old.to_vec();
    if let Some(new) = candidate.new_in(state, problem.rig) {
        let (beta, _) = carried(problem, around.small, state, &regression, around.beta);
        regression.coupled.extend(tangents(problem, state, new, &regression, &beta));
    }
    Grams::new(&regression, &problem.blocks).cross_validate(&problem.blocks, state.form.ridge)
}

/// Chooses for each fold the guess with the smallest error on the rest.
fn chosen(problem: &Problem, tried: &[(usize, CrossValidated)]) -> Option<Scanned> {
    let blocks = &problem.blocks;
    let best_on = |fold: usize| tried.iter().min_by(|a, b| a.1.train[fold].total_cmp(&b.1.train[fold]));
    let picks: Option<Vec<&CrossValidated>> = (0..blocks.folds).map(|fold| best_on(fold).map(|best| &best.1)).collect();
    let picks = picks?;
    let losses = (0..blocks.len()).map(|b| picks[blocks.fold[b]].loss[b]).collect();
    let total = |cv: &CrossValidated| cv.loss.iter().sum::<f64>();
    let best = tried.iter().min_by(|a, b| total(&a.1).total_cmp(&total(&b.1)))?.0;
    Some(Scanned { losses, best })
}
