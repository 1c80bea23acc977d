//! The regression of a state at the N samples that are compared.
//!
//! ```text
//! w_m (y_m − b_m) = Σ_j X_j β_jm + Σ_k Z_km α_k + e_m
//! ```
//!
//! | symbol | meaning                                                                      | shape |
//! | `b`    | base at the inputs after effects, with loads, frame and output               | N × M |
//! | `X`    | columns with one coefficient per output: the correction's monomials, kinks and sums of angles, linear parameters | N × p |
//! | `Z`    | columns with one coefficient for all outputs                                 | c of N × M |
//! | `w`    | weight of an output                                                          | M     |

use nalgebra::DMatrix;
use rayon::prelude::*;

mod about;
mod base;
mod correction;
mod inputs;
mod left;
mod rows;

use super::problem::Problem;
use super::state::State;

pub use super::moved::{carried, moved, tangents};
pub use super::state::modes;
pub use inputs::{inputs, keep_inputs, record};
pub use left::left;

use correction::Basis;
use rows::{Rows, nominal_kept, rows};

/// Matrices of a regression.
#[derive(Debug, Clone)]
pub struct Design {
    /// Columns X.
    pub x: DMatrix<f64>,
    /// Columns Z of each output.
    pub coupled: Vec<DMatrix<f64>>,
    /// Weighted targets, N × M.
    pub y: DMatrix<f64>,
    /// Ones for the columns of X that the ridge shrinks, else zeros.
    pub shrunk: Vec<f64>,
    /// Number of columns of X that belong to the correction.
    pub correction: usize,
}

/// Returns the regression of a state.
pub fn design(problem: &Problem, state: &State) -> Design {
    let basis = Basis::of(problem, state);
    let correction = basis.as_ref().map_or(0, Basis::len);
    let of = |s: usize| rows(problem, state, basis.as_ref(), s);
    let parts: Vec<Rows> = (0..problem.series.len()).into_par_iter().map(of).collect();
    let (count, columns) = (problem.rows(), parts.first().map_or(0, Rows::columns));
    let (mut x, mut y, mut first) = (DMatrix::zeros(count, columns), DMatrix::zeros(count, problem.outputs()), 0);
    for part in &parts {
        part.copy_to(x.rows_mut(first, part.y.nrows()));
        y.rows_mut(first, part.y.nrows()).copy_from(&part.y);
        first += part.y.nrows();
    }
    let mut shrunk = vec![1.0; columns];
    if correction > 0 {
        shrunk[0] = 0.0;
    }
    Design { x, coupled: vec![], y, shrunk, correction }
}

/// Caches what states that begin with this one share: the actuators after the first input effects, and the columns of the nominal form.
pub fn keep(problem: &Problem, state: &State) {
    keep_inputs(problem, state);
    let basis = Basis::of(problem, state);
    (0..problem.series.len()).into_par_iter().for_each(|s| {
        nominal_kept(problem, state, basis.as_ref(), s);
    });
}
