//! Change of the outputs by one effect: on top of the others, without it, and to first order.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::design::{Design, design, left};
use super::problem::Problem;
use super::projected::Projected;
use super::state::{Part, Placed, State, modes};

/// Converts a solution of `small` to the columns of another state, zero for new columns, and returns which columns are
/// new.
pub fn carried(
    problem: &Problem,
    small: &State,
    state: &State,
    regression: &Design,
    beta: &DMatrix<f64>,
) -> (DMatrix<f64>, Vec<usize>) {
    let width = problem.outputs();
    let groups = |state: &State, correction: usize| -> Vec<(String, usize)> {
        let additive = state.effects.iter().filter(|placed| placed.part() == Part::Additive);
        let named = additive.flat_map(|placed| {
            (0..placed.linear().len() / width).map(|group| format!("{} {group}", placed.label(problem.rig)))
        });
        named.enumerate().map(|(k, name)| (name, correction + k)).collect()
    };
    let old_correction = beta.nrows() - groups(small, 0).len();
    let old = groups(small, old_correction);
    let correction = (0..regression.correction).map(|j| (j < old_correction).then_some(j));
    let additive =
        groups(state, 0).into_iter().map(|(name, _)| old.iter().find(|(known, _)| *known == name).map(|k| k.1));
    let from: Vec<Option<usize>> = correction.chain(additive).collect();
    let known = DMatrix::from_fn(from.len(), width, |j, o| from[j].map_or(0.0, |row| beta[(row, o)]));
    let new = (0..from.len()).filter(|&j| from[j].is_none()).collect();
    (known, new)
}

/// Returns the change of the weighted outputs by effect `i`, N × M, with the coefficients of the state as it is.
pub fn moved(problem: &Problem, state: &State, fitted: &Projected, i: usize) -> DMatrix<f64> {
    let rest = State { forgiven: modes(state), ..state.without(i) };
    let regression = design(problem, &rest);
    let (beta, _) = carried(problem, state, &rest, &regression, &fitted.beta);
    &regression.y - &regression.x * beta - &fitted.residual
}

/// Finite-difference step of tangents, in parameter scales.
const TANGENT: f64 = 1e-3;

/// Returns Z: the first-order change of the outputs by the signed parameters of effect `new`, around coefficients β (p
/// × M) of the state's regression.
pub fn tangents(
    problem: &Problem,
    state: &State,
    new: usize,
    regression: &Design,
    beta: &DMatrix<f64>,
) -> Vec<DMatrix<f64>> {
    let placed = &state.effects[new];
    let specs = placed.instance.parameters();
    let signed = placed.free().into_iter().filter(|&j| !(specs[j].lower >= 0.0 && placed.theta[j] > 0.0));
    let signed: Vec<usize> = signed.collect();
    if signed.is_empty() {
        return vec![];
    }
    let here = &regression.y - &regression.x * beta;
    let columns = signed.into_iter().map(|j| {
        let step = TANGENT * specs[j].scale;
        let mut theta = placed.theta.clone();
        theta[j] += step;
        let mut moved = state.clone();
        moved.effects[new] = Arc::new(Placed { theta, ..(**placed).clone() });
        (&here - left(problem, &moved, beta)) / step
    });
    columns.filter(|z| z.iter().all(|z| z.is_finite()) && z.amax() > 0.0).collect()
}
