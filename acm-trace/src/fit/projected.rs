//! A state at one point of its nonlinear parameters: all linear parameters are solved for.

use nalgebra::DMatrix;

use super::blocks::Blocks;
use super::design::{Design, design};
use super::gram::Grams;
use super::problem::Problem;
use super::state::State;

/// A solution at one point.
#[derive(Debug, Clone)]
pub struct Projected {
    /// Coefficients β, p × M.
    pub beta: DMatrix<f64>,
    /// Residual y − Xβ, N × M.
    pub residual: DMatrix<f64>,
    /// Regression that was solved.
    pub design: Design,
}

/// Solves for all linear parameters; none where the equations are singular or not finite.
pub fn project(problem: &Problem, state: &State) -> Option<Projected> {
    let design = design(problem, state);
    let rows = design.x.nrows();
    let whole = Blocks::whole(rows);
    let beta = Grams::new(&design, &whole).solve(state.form.ridge)?.beta;
    let residual = if beta.is_empty() { design.y.clone() } else { &design.y - &design.x * &beta };
    residual.iter().all(|r| r.is_finite()).then_some(Projected { beta, residual, design })
}
