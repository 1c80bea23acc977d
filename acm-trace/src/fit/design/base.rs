//! Part without coefficients: the base, loads on the arm, and what acts after them.

use acm_core::augmented;
use acm_core::effects::Site;
use nalgebra::DMatrix;

use super::inputs::acting;
use crate::fit::columns::{Key, Kind};
use crate::fit::problem::Problem;
use crate::fit::state::{Part, Placed, State};

/// Returns g at the inputs after effects; zero without a base.
pub fn base(problem: &Problem, q: &[f64], rows: usize) -> DMatrix<f64> {
    match problem.base {
        Some(base) => base.stands_for.predict(&DMatrix::from_column_slice(rows, problem.range.len(), q)),
        None => DMatrix::zeros(rows, problem.outputs()),
    }
}

/// Adds loads on the arm, and then all other effects that act after it, at the samples that count, without the offset s − g.
pub fn loaded(problem: &Problem, state: &State, s: usize, mut given: DMatrix<f64>) -> DMatrix<f64> {
    let series = &problem.series[s];
    let others = acting(state, series, Part::Other);
    if others.is_empty() {
        return given;
    }
    let width = problem.outputs();
    let (later, loads): (Vec<&Placed>, Vec<&Placed>) =
        others.into_iter().partition(|placed| matches!(placed.instance.site(), Site::Frame | Site::Output));
    if !loads.is_empty() && !problem.fields[s].is_empty() {
        let moved = problem.columns.get(Key::together(Kind::Loads, s, &loads, &[]), || displaced(problem, s, &loads));
        given.iter_mut().zip(moved.iter()).for_each(|(given, moved)| *given += moved);
    }
    if later.is_empty() {
        return given;
    }
    let mut columns = vec![vec![0.0; series.samples()]; width];
    let each = || problem.kept[s].iter().enumerate().flat_map(|(k, &n)| (0..width).map(move |o| (k, n, o)));
    let offset = |n: usize, o: usize| problem.offset[s][n * width + o];
    each().for_each(|(k, n, o)| columns[o][n] = given[(k, o)] + offset(n, o));
    later.iter().for_each(|placed| placed.instance.act(&placed.theta, &series.thin, &mut columns));
    each().for_each(|(k, n, o)| given[(k, o)] = columns[o][n] - offset(n, o));
    given
}

/// Returns the displacement of the outputs by loads on the arm at the compared samples, column by column.
fn displaced(problem: &Problem, s: usize, loads: &[&Placed]) -> Vec<f64> {
    let (series, width) = (&problem.series[s], problem.outputs());
    let mut y = vec![0.0; series.samples() * width];
    let (instances, theta): (Vec<_>, Vec<&[f64]>) =
        loads.iter().map(|placed| (placed.instance.clone(), placed.theta.as_slice())).unzip();
    if let Some(loads) = augmented::loads(&instances, &theta, &series.record) {
        let thin: Vec<Vec<f64>> = loads.iter().map(|column| series.rows.iter().map(|&t| column[t]).collect()).collect();
        augmented::displace(&thin, &problem.fields[s], &mut y);
    }
    (0..width).flat_map(|o| problem.kept[s].iter().map(move |&n| (n, o))).map(|(n, o)| y[n * width + o]).collect()
}
