//! How much of what a correction leaves of an effect another effect explains.
//!
//! Every value to begin with is tried, with parameters that have a sign taken to first order around it; the best are refined.

use acm_core::effects::instance::Instance;
use acm_trace::fit::blocks::Blocks;
use acm_trace::fit::design::{design, tangents};
use acm_trace::fit::gram::Grams;
use acm_trace::fit::problem::Problem;
use acm_trace::fit::refine::{project, refine};
use acm_trace::fit::state::State;
use nalgebra::DMatrix;

/// Values to begin with, at most.
const GUESSES: usize = 12;

/// What explains less than this to first order is not refined.
const WORTH_REFINING: f64 = 0.3;

/// Values to begin with that are refined, and steps of a refinement.
const REFINED: (usize, usize) = (2, 15);

/// A share that is as good as all.
const ENOUGH: f64 = 0.9995;

/// Share of the planted change below which the correction has taken it up, and nothing is left to explain.
const TAKEN_UP: f64 = 1e-3;

/// What is to be explained: trials with a planted effect, and the best that the correction alone does with them.
pub struct Planted<'a> {
    problem: Problem<'a>,
    bare: State,
    beta: DMatrix<f64>,
    left: f64,
}

impl<'a> Planted<'a> {
    /// `change`: sum of squares of what the effect does to the weighted outputs. None where the correction takes it up.
    pub fn new(problem: Problem<'a>, bare: State, change: f64) -> Option<Self> {
        let fitted = project(&problem, &bare)?;
        let (beta, left) = (fitted.beta, fitted.residual.norm_squared());
        (left > TAKEN_UP * change).then_some(Self { problem, bare, beta, left })
    }

    /// Share that an effect explains with its values free and the correction fitted again.
    pub fn explained_by(&self, instance: &Instance) -> f64 {
        let guesses = instance.initial_guesses(self.problem.rig);
        let stride = guesses.len().div_ceil(GUESSES).max(1);
        let mut tried: Vec<(f64, State)> = guesses
            .into_iter()
            .step_by(stride)
            .map(|guess| self.bare.with(instance.clone(), guess))
            .filter_map(|state| Some((self.first_order(&state)?, state)))
            .collect();
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        let Some((least, _)) = tried.first() else { return 0.0 };
        if self.share(*least) < WORTH_REFINING {
            return self.share(*least);
        }
        let mut best = 0.0_f64;
        for (_, state) in tried.iter().take(REFINED.0) {
            let refined = refine(&self.problem, state, REFINED.1);
            let left = project(&self.problem, &refined).map_or(self.left, |fitted| fitted.residual.norm_squared());
            best = best.max(self.share(left));
            if best > ENOUGH {
                break;
            }
        }
        best
    }

    fn share(&self, left: f64) -> f64 {
        (1.0 - left / self.left).clamp(0.0, 1.0)
    }

    /// Sum of squares that is left with the effect at these values, its signed ones to first order.
    fn first_order(&self, state: &State) -> Option<f64> {
        let mut regression = design(&self.problem, state);
        regression.coupled = tangents(&self.problem, state, 0, &self.beta);
        let rows = regression.x.nrows();
        let whole = Blocks { rows: vec![0..rows], fold: vec![0], folds: 1, by_trial: true };
        let solved = Grams::new(&regression, &regression.y, &whole).solve(self.bare.form.ridge)?;
        let mut left = regression.y.clone();
        if !solved.beta.is_empty() {
            left -= &regression.x * &solved.beta;
        }
        regression.coupled.iter().zip(solved.alpha.iter()).for_each(|(z, alpha)| left -= z * *alpha);
        let sum = left.norm_squared();
        sum.is_finite().then_some(sum)
    }
}
