//! The residual of a state with given coefficients, y − X β, without its columns: they are summed before they are filtered.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::{Basis, Rows, below, rows};
use crate::fit::problem::Problem;
use crate::fit::state::State;

/// Returns y − X β at the samples that are compared, N × M.
pub fn left(problem: &Problem, state: &State, beta: &DMatrix<f64>) -> DMatrix<f64> {
    let basis = Basis::of(problem, state);
    let of = |s: usize| {
        let Rows { x, y } = rows(problem, state, basis.as_ref(), s, Some(beta));
        Rows { x: DMatrix::zeros(y.nrows(), 0), y: y - x }
    };
    let parts: Vec<Rows> = (0..problem.series.len()).into_par_iter().map(of).collect();
    below(&parts).1
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::design::design;
    use crate::fit::form::Form;

    /// Oracle: y − X β of the regression, whose columns are filtered one by one; with a signal that is added, offsets of trials, and
    /// an effect on the inputs.
    #[test]
    fn what_is_left_of_a_sum_is_left_of_its_columns() {
        let rig = bench::rig(&["q"], &["c"], &["y", "z"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).sin()).collect();
        let c: Vec<f64> = bench::time().iter().map(|t| (0.6 * t).cos()).collect();
        let y = q.iter().zip(&c).flat_map(|(q, c)| [q + c, q * c]).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![c], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0, 0.5], None).with_offsets(0.4);
        let bare = State::bare(Form { degree: Some(2), ..Form::LINEAR });
        let added = bare.with(bench::placed("context_term", Carrier::Context(0), &rig, &[1.0]));
        let played = added.with(bench::placed("backlash", Carrier::Rig, &rig, &[0.1]));
        let filtered = played.with(bench::placed("measurement_second_order", Carrier::Rig, &rig, &[0.8, 0.3]));
        for state in [bare, added, played, filtered] {
            let regression = design(&problem, &state);
            let beta = DMatrix::from_fn(regression.x.ncols(), 2, |j, o| 0.3 + j as f64 - 0.7 * o as f64);
            let apart = (left(&problem, &state, &beta) - (&regression.y - &regression.x * &beta)).amax();
            assert!(apart < 1e-11, "{apart} {:?}", state.labels(&rig));
        }
    }
}
