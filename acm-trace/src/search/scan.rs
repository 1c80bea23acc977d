//! Cross-validated errors of candidates, honest about the values to begin with: those are chosen without the fold.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::candidates::Candidate;
use crate::fit::design::{design, tangents};
use crate::fit::gram::{CrossValidated, Grams};
use crate::fit::problem::Problem;
use crate::fit::state::State;

/// Sum of squares of each block left out.
pub type Losses = Vec<f64>;

/// What a candidate comes to.
#[derive(Debug, Clone)]
pub struct Scanned {
    /// Losses on the recorded outputs, then on each surrogate: `[set][block]`.
    pub losses: Vec<Losses>,
    /// Which of the values to begin with predicts best.
    pub best: usize,
}

/// Losses of one state; none where its equations are singular.
pub fn cross_validate(problem: &Problem, state: &State) -> Option<Losses> {
    let regression = design(problem, state);
    let grams = Grams::new(&regression, &regression.y, &problem.blocks);
    grams.cross_validate(&problem.blocks, state.form.ridge, 1).map(|cv| cv.loss.into_iter().next().unwrap_or_default())
}

/// Scans every candidate, around a solution β of the state without them, on the recorded outputs or on `surrogates`: what is added to the outputs, set beside set.
pub fn scan(
    problem: &Problem,
    candidates: &[Candidate],
    beta: &DMatrix<f64>,
    surrogates: Option<&DMatrix<f64>>,
    most: usize,
) -> Vec<Option<Scanned>> {
    let thinned = |states: usize| states.div_ceil(most).max(1);
    let work: Vec<(usize, usize)> = candidates
        .iter()
        .enumerate()
        .flat_map(|(c, candidate)| {
            (0..candidate.states.len()).step_by(thinned(candidate.states.len())).map(move |k| (c, k))
        })
        .collect();
    let done: Vec<Option<CrossValidated>> =
        work.par_iter().map(|&(c, k)| of_guess(problem, &candidates[c], k, beta, surrogates)).collect();
    let mut of: Vec<Vec<(usize, CrossValidated)>> = vec![vec![]; candidates.len()];
    for ((c, k), cv) in work.into_iter().zip(done) {
        of[c].extend(cv.map(|cv| (k, cv)));
    }
    of.into_iter().map(|tried| chosen(problem, tried)).collect()
}

/// One value to begin with; parameters that have a sign are linear around it.
fn of_guess(
    problem: &Problem,
    candidate: &Candidate,
    guess: usize,
    beta: &DMatrix<f64>,
    surrogates: Option<&DMatrix<f64>>,
) -> Option<CrossValidated> {
    let state = &candidate.states[guess];
    let mut regression = design(problem, state);
    regression.coupled = candidate.new.map_or(vec![], |new| tangents(problem, state, new, beta));
    let (y, sets) = match surrogates {
        None => (regression.y.clone(), 1),
        Some(added) => (beside(&regression.y, added), added.ncols() / regression.y.ncols().max(1)),
    };
    Grams::new(&regression, &y, &problem.blocks).cross_validate(&problem.blocks, state.form.ridge, sets)
}

/// The targets with each set added.
fn beside(y: &DMatrix<f64>, added: &DMatrix<f64>) -> DMatrix<f64> {
    let mut all = added.clone();
    let width = y.ncols();
    all.column_iter_mut().enumerate().for_each(|(c, mut column)| column += y.column(c % width));
    all
}

/// For each fold the guess with the smallest error on the rest.
fn chosen(problem: &Problem, tried: Vec<(usize, CrossValidated)>) -> Option<Scanned> {
    let sets = tried.first()?.1.loss.len();
    let blocks = &problem.blocks;
    let losses = (0..sets)
        .map(|set| {
            let pick = |fold: usize| {
                let by = |a: &&(usize, CrossValidated), b: &&(usize, CrossValidated)| {
                    a.1.train[set][fold].total_cmp(&b.1.train[set][fold])
                };
                tried.iter().min_by(by).map_or(0, |best| tried.iter().position(|t| t.0 == best.0).unwrap_or(0))
            };
            let picks: Vec<usize> = (0..blocks.folds).map(pick).collect();
            (0..blocks.len()).map(|b| tried[picks[blocks.fold[b]]].1.loss[set][b]).collect()
        })
        .collect();
    let total = |cv: &CrossValidated| cv.loss[0].iter().sum::<f64>();
    let best = tried.iter().min_by(|a, b| total(&a.1).total_cmp(&total(&b.1)))?.0;
    Some(Scanned { losses, best })
}
