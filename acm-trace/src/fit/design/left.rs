//! The residual y − X β of a state with given coefficients; columns are summed before they are filtered.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::correction::Basis;
use super::inputs::{acting, record};
use super::rows::{course, filtered, groups, kept, matrix, parted, rows, targets, unfiltered};
use crate::fit::problem::Problem;
use crate::fit::state::{Part, State};
use crate::fit::unrecorded::Unrecorded;

/// Returns y − X β at the samples that are compared, N × M.
pub fn left(problem: &Problem, state: &State, beta: &DMatrix<f64>) -> DMatrix<f64> {
    let basis = Basis::of(problem, state);
    let of = |s: usize| of_trial(problem, state, basis.as_ref(), s, beta);
    let parts: Vec<DMatrix<f64>> = (0..problem.series.len()).into_par_iter().map(of).collect();
    let rows = parts.iter().map(DMatrix::nrows).sum();
    let (mut all, mut first) = (DMatrix::zeros(rows, problem.outputs()), 0);
    for part in parts {
        all.rows_mut(first, part.nrows()).copy_from(&part);
        first += part.nrows();
    }
    all
}

fn of_trial(problem: &Problem, state: &State, basis: Option<&Basis>, s: usize, beta: &DMatrix<f64>) -> DMatrix<f64> {
    let filters = acting(state, &problem.series[s], Part::Filter);
    if filters.is_empty() {
        return rows(problem, state, basis, s).less(beta);
    }
    let record = record(problem, state, s);
    let of = |(placed, group)| course(problem, state, (s, &record), placed, group);
    let additive = matrix(&groups(problem, state).map(of).collect::<Vec<_>>(), record.samples());
    let nominal = unfiltered(problem, state, basis, s);
    let (base, x) = parted(&nominal, record.samples(), problem.outputs());
    let first = x.ncols();
    let mut sum = x * beta.rows(0, first) + &additive * beta.rows(first, additive.ncols());
    let mut base = base.into_owned();
    filtered(&filters, &record, &mut sum);
    filtered(&filters, &record, &mut base);
    let (kept, unrecorded) = (kept(problem, s), Unrecorded::new(problem, state, s));
    let y = targets(problem, state, s, base.select_rows(&kept), &unrecorded);
    y - unrecorded.taken_out(sum.select_rows(&kept))
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
