//! Residuals of a state on blocks left out, trial by trial.

use nalgebra::DMatrix;

use crate::assemble::Assembled;
use crate::diagnose::remainder::{Remainder, TrialRemainder};
use crate::fit::design::{Design, design, inputs};
use crate::fit::gram;
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::series::Series;

/// Residuals of each trial [N×M], weighted, with the slopes of the model there.
#[derive(Debug, Clone)]
pub struct LeftOut {
    /// Weighted residuals of the N samples; zero where a sample does not count.
    pub residual: Vec<Vec<f64>>,
    /// Slopes ∂y/∂q of the nominal model, N × M × A.
    slopes: Vec<Vec<f64>>,
    /// Columns that the correction absorbs, one for each monomial and output, NM × pM.
    pub absorbed: Vec<DMatrix<f64>>,
    block: Vec<Vec<usize>>,
}

/// Returns the residuals of a state on blocks left out; none where its equations are singular.
pub fn left_out(problem: &Problem, state: &State) -> Option<LeftOut> {
    let regression = design(problem, state);
    let residual = gram::left_out(&regression, &problem.blocks, state.form.ridge)?;
    let assembled = Assembled::new(problem, state)?;
    let width = problem.outputs();
    let edges = problem.edges();
    let mut all = LeftOut { residual: vec![], slopes: vec![], absorbed: vec![], block: vec![] };
    for (s, series) in problem.series.iter().enumerate() {
        let mut own = vec![0.0; series.samples() * width];
        let mut block = vec![0; series.samples()];
        for (k, &n) in problem.kept[s].iter().enumerate() {
            let row = edges[s] + k;
            for o in 0..width {
                own[n * width + o] = residual[(row, o)];
            }
            block[n] = problem.blocks.rows.iter().position(|rows| rows.contains(&row)).unwrap_or(0);
        }
        let first = problem.kept[s].first().map_or(0, |&n| block[n]);
        block.iter_mut().take(problem.kept[s].first().copied().unwrap_or(0)).for_each(|b| *b = first);
        let linear = assembled.response.linearised_at(&inputs(problem, state, s), &series.rows);
        all.absorbed.push(absorbed(problem, &regression, s));
        all.slopes.push(linear.by_actuator);
        all.residual.push(own);
        all.block.push(block);
    }
    Some(all)
}

/// Returns each column of the correction on each output, at the N samples of a trial; zero where a sample does not
/// count.
fn absorbed(problem: &Problem, regression: &Design, s: usize) -> DMatrix<f64> {
    let (width, first) = (problem.outputs(), problem.edges()[s]);
    let mut columns = DMatrix::zeros(problem.series[s].samples() * width, regression.correction * width);
    for (k, &n) in problem.kept[s].iter().enumerate() {
        for (j, o) in (0..regression.correction).flat_map(|j| (0..width).map(move |o| (j, o))) {
            columns[(n * width + o, j * width + o)] = regression.x[(first + k, j)];
        }
    }
    columns
}

impl LeftOut {
    /// Returns the residuals with the signals that may explain them.
    pub fn remainder<'r>(&'r self, problem: &'r Problem, floor: f64) -> Remainder<'r> {
        let trials = problem.series.iter().enumerate().map(|(s, series)| TrialRemainder {
            name: &series.name,
            record: &series.thin,
            residual: self.residual[s].clone(),
            counts: &series.counts,
            slopes: &self.slopes[s],
            block: &self.block[s],
        });
        Remainder { rig: problem.rig, trials: trials.collect(), floor }
    }
}

/// Returns the change of the weighted outputs by effect `i`, N×M of each trial; none where the regression is singular.
pub fn changes(problem: &Problem, state: &State, i: usize) -> Option<Vec<DMatrix<f64>>> {
    let whole = Assembled::new(problem, state)?;
    let mut rest = whole.clone();
    rest.effects.remove(i);
    let (whole, rest) = (whole.model(), rest.model());
    let of = |series: &Series| {
        let nothing = DMatrix::zeros(series.record.samples(), problem.outputs());
        let change = whole.predict(&series.record, Some(&nothing)) - rest.predict(&series.record, Some(&nothing));
        DMatrix::from_fn(series.rows.len(), problem.outputs(), |k, o| change[(series.rows[k], o)] * problem.weight[o])
    };
    Some(problem.series.iter().map(of).collect())
}

/// Returns the root mean square of changes over the samples that are compared.
pub fn size(problem: &Problem, changes: &[DMatrix<f64>]) -> f64 {
    let (mut squares, mut count) = (0.0, 0usize);
    for (change, kept) in changes.iter().zip(&problem.kept) {
        squares += kept.iter().map(|&k| change.row(k).norm_squared()).sum::<f64>();
        count += kept.len();
    }
    (squares / count.max(1) as f64).sqrt()
}
