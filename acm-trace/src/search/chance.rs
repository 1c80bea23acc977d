//! Gain of the best of all candidates by chance, compared with the gain of a candidate.
//!
//! ```text
//! D = (I − P_X) D_c,   α_f = (Σ_{b∉f} DᵀD)⁻¹ Σ_{b∉f} Dᵀe*,   gain = Σ_f (2 α_fᵀ Dᵀe* − α_fᵀ DᵀD α_f) / ‖e*‖² over the rows of f
//! ```
//!
//! | symbol | meaning                                                                                            |
//! | `e*`   | residual of the larger model with its phases drawn at random (`surrogate`)                           |
//! | `D_c`  | what a candidate adds: columns of its own, and the change of the prediction at initial values      |
//! | `P_X`  | projection on the columns of the smaller model                                                     |
//!
//! Initial values are chosen without the fold, as in the search. A change of the prediction has a free coefficient here, and 1 in the
//! model: chance is over- rather than underestimated.

mod surrogate;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use self::surrogate::{quantile_of_maximum, sets};
use super::candidates::Candidate;
use crate::fit::blocks::Blocks;
use crate::fit::design::{Design, design};
use crate::fit::moved::{carried, tangents};
use crate::fit::problem::Problem;
use crate::fit::projected::{Projected, project};
use crate::fit::state::State;
use crate::tall::product;

/// Smallest part of a column that must remain once others are projected out.
const RANK: f64 = 1e-6;

/// Number and level of surrogates.
#[derive(Debug, Clone, Copy)]
pub struct Draws {
    /// Number of surrogates.
    pub count: usize,
    /// Probability that any candidate passes.
    pub family_wise: f64,
    /// Seed of the phases.
    pub seed: u64,
}

/// Returns the quantile of the largest gain of all candidates on surrogates of the residuals of `large`; none where a
/// model is singular.
pub fn largest_by_chance(
    problem: &Problem,
    small: &State,
    large: &State,
    candidates: &[Candidate],
    draws: Draws,
) -> Option<f64> {
    let (fitted, left) = (project(problem, small)?, project(problem, large)?.residual);
    let projection = Projection::new(&fitted.design, small.form.ridge)?;
    let drawn = projection.of(&sets(&left, &problem.edges(), draws.count, draws.seed));
    let width = problem.outputs();
    let before: Vec<f64> = (0..draws.count).map(|set| drawn.columns(set * width, width).norm_squared()).collect();
    let of = |candidate: &Candidate| explained(problem, (small, &fitted), &projection, candidate, &drawn);
    let gains: Vec<Vec<f64>> = candidates.par_iter().map(of).collect();
    let largest: Vec<f64> =
        (0..draws.count).map(|set| gains.iter().map(|gains| gains[set] / before[set]).fold(0.0, f64::max)).collect();
    Some(quantile_of_maximum(&largest, draws.family_wise))
}

/// Returns the squares of each set that a candidate removes from folds left out.
fn explained(
    problem: &Problem,
    small: (&State, &Projected),
    projection: &Projection,
    candidate: &Candidate,
    drawn: &DMatrix<f64>,
) -> Vec<f64> {
    let count = drawn.ncols() / problem.outputs().max(1);
    let blocks = &problem.blocks;
    // Reduction by the best initial values so far: on the rows kept, and on the fold.
    let mut best = vec![vec![(0.0, 0.0); count]; blocks.folds];
    for k in candidate.coarse() {
        let directions = Directions::new(problem, small, projection, candidate, &candidate.states[k]);
        for (own, best) in directions.gains(drawn, blocks).into_iter().zip(&mut best) {
            own.into_iter().zip(best).filter(|(own, best)| own.0 > best.0).for_each(|(own, best)| *best = own);
        }
    }
    (0..count).map(|set| best.iter().map(|of_fold| of_fold[set].1).sum()).collect()
}

/// Projection I − P_X.
struct Projection {
    /// Factor L⁻¹ Xᵀ with XᵀX + λ n D = L Lᵀ, p × N.
    w: DMatrix<f64>,
}

/// Value added to the diagonal, relative to a column's own square.
const JITTER: f64 = 1e-10;

impl Projection {
    fn new(design: &Design, ridge: f64) -> Option<Self> {
        let x = &design.x;
        let mut g = product(x, x, 0..x.nrows());
        for j in 0..g.nrows() {
            g[(j, j)] += (ridge * design.shrunk[j] + JITTER) * g[(j, j)] + f64::MIN_POSITIVE;
        }
        let l = g.cholesky()?.unpack();
        Some(Self { w: l.solve_lower_triangular(&x.transpose())? })
    }

    fn of(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let along = &self.w * columns;
        let mut rest = columns.clone();
        rest.gemm_tr(-1.0, &self.w, &along, 1.0);
        rest
    }
}

/// Orthonormal directions that a candidate adds.
struct Directions {
    /// Directions for each output alike, N × k.
    own: DMatrix<f64>,
    /// Directions with one coefficient for all outputs, N × M each.
    shared: Vec<DMatrix<f64>>,
}

impl Directions {
    fn new(
        problem: &Problem,
        (small, fitted): (&State, &Projected),
        projection: &Projection,
        candidate: &Candidate,
        state: &State,
    ) -> Self {
        let regression = design(problem, state);
        let (beta, new) = carried(problem, small, state, &regression, &fitted.beta);
        let change = &fitted.residual - (&regression.y - &regression.x * &beta);
        let mut shared = vec![change];
        shared.extend(
            candidate
                .new_in(state, problem.rig)
                .map_or(vec![], |new| tangents(problem, state, new, &regression, &beta)),
        );
        let own = orthonormal(projection.of(&regression.x.select_columns(&new)));
        let rest = |z: DMatrix<f64>| {
            let z = projection.of(&z);
            &z - &own * own.tr_mul(&z)
        };
        let shared = orthonormal_together(shared.into_iter().map(rest).collect());
        Self { own, shared }
    }
}

impl Directions {
    /// Returns for each fold and set: squares removed from the rows kept, and from the fold.
    fn gains(&self, drawn: &DMatrix<f64>, blocks: &Blocks) -> Vec<Vec<(f64, f64)>> {
        let width = self.shared.first().map_or(1, DMatrix::ncols);
        let parts: Vec<Part> =
            (0..blocks.folds).map(|fold| Part::new(self, drawn, blocks.rows_of(fold), width)).collect();
        let whole = parts.iter().fold(parts[0].zero(), |sum, part| sum.plus(part, 1.0));
        parts.iter().map(|part| whole.plus(part, -1.0).gains(part, width)).collect()
    }
}

/// Products of directions and surrogates over some rows.
struct Part {
    /// Products DᵀD of the columns of an output, and of those that outputs share.
    squares: [DMatrix<f64>; 2],
    /// Products Dᵀe*: k × M·sets, and c × sets.
    along: [DMatrix<f64>; 2],
}

impl Part {
    fn new(directions: &Directions, drawn: &DMatrix<f64>, rows: Vec<Range<usize>>, width: usize) -> Self {
        let (k, c, sets) = (directions.own.ncols(), directions.shared.len(), drawn.ncols() / width);
        let mut part = Self {
            squares: [DMatrix::zeros(k, k), DMatrix::zeros(c, c)],
            along: [DMatrix::zeros(k, drawn.ncols()), DMatrix::zeros(c, sets)],
        };
        for rows in rows {
            part.squares[0] += product(&directions.own, &directions.own, rows.clone());
            part.along[0] += product(&directions.own, drawn, rows.clone());
            for (i, one) in directions.shared.iter().enumerate() {
                let one = one.rows(rows.start, rows.len());
                for (j, other) in directions.shared.iter().enumerate().take(i + 1) {
                    let dot = one.dot(&other.rows(rows.start, rows.len()));
                    part.squares[1][(i, j)] += dot;
                    part.squares[1][(j, i)] = part.squares[1][(i, j)];
                }
                for set in 0..sets {
                    part.along[1][(i, set)] += one.dot(&drawn.view((rows.start, set * width), (rows.len(), width)));
                }
            }
        }
        part
    }

    fn zero(&self) -> Self {
        let zero = |m: &DMatrix<f64>| DMatrix::zeros(m.nrows(), m.ncols());
        Self { squares: self.squares.each_ref().map(zero), along: self.along.each_ref().map(zero) }
    }

    fn plus(&self, other: &Self, sign: f64) -> Self {
        let sum = |own: &[DMatrix<f64>; 2], other: &[DMatrix<f64>; 2]| {
            [&own[0] + &other[0] * sign, &own[1] + &other[1] * sign]
        };
        Self { squares: sum(&self.squares, &other.squares), along: sum(&self.along, &other.along) }
    }

    /// Returns the squares that coefficients from these rows remove from them, and from the rows of `fold`, in each
    /// set.
    fn gains(&self, fold: &Self, width: usize) -> Vec<(f64, f64)> {
        let sets = self.along[1].ncols();
        let mut gains = vec![(0.0, 0.0); sets];
        for (kind, per_set) in [width, 1].into_iter().enumerate() {
            let (squares, along) = (&self.squares[kind], &self.along[kind]);
            let mut jittered = squares.clone();
            (0..jittered.nrows()).for_each(|j| jittered[(j, j)] += RANK * squares[(j, j)] + f64::MIN_POSITIVE);
            let Some(alpha) = jittered.cholesky().map(|factor| factor.solve(along)) else { continue };
            let (kept, left_out) = (squares * &alpha, &fold.squares[kind] * &alpha);
            for (set, gains) in gains.iter_mut().enumerate() {
                for column in set * per_set..(set + 1) * per_set {
                    let alpha = alpha.column(column);
                    gains.0 += 2.0 * alpha.dot(&along.column(column)) - alpha.dot(&kept.column(column));
                    gains.1 += 2.0 * alpha.dot(&fold.along[kind].column(column)) - alpha.dot(&left_out.column(column));
                }
            }
        }
        gains
    }
}

/// Orthonormalises columns by Gram–Schmidt.
fn orthonormal(columns: DMatrix<f64>) -> DMatrix<f64> {
    let mut found: Vec<DVector<f64>> = vec![];
    for column in columns.column_iter() {
        let mut rest = column.into_owned();
        let before = rest.norm();
        found.iter().for_each(|q| rest.axpy(-q.dot(&rest), q, 1.0));
        let norm = rest.norm();
        if norm.is_finite() && norm > RANK * before && norm > 0.0 {
            found.push(rest / norm);
        }
    }
    if found.is_empty() { DMatrix::zeros(columns.nrows(), 0) } else { DMatrix::from_columns(&found) }
}

fn orthonormal_together(columns: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
    let mut found: Vec<DMatrix<f64>> = vec![];
    for column in columns {
        let before = column.norm();
        let mut rest = column;
        found.iter().for_each(|q| rest -= q * q.dot(&rest));
        let norm = rest.norm();
        if norm.is_finite() && norm > RANK * before && norm > 0.0 {
            found.push(rest / norm);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Returns numbers without a pattern between −1 and 1.
    fn number(k: usize) -> f64 {
        ((k * k + 7 * k) as f64 * 0.754_877).sin()
    }

    /// Oracle: the regression of each output on a column, without each fold in turn, written out.
    #[test]
    fn gains_are_those_of_a_regression_without_the_fold() {
        let blocks = Blocks::new(&[240]);
        let column = DMatrix::from_fn(240, 1, |t, _| 1.0 + number(t));
        let drawn = DMatrix::from_fn(240, 2, |t, o| number(1000 + 3 * t + o));
        let directions = Directions { own: column.clone(), shared: vec![DMatrix::zeros(240, 1)] };
        let found = directions.gains(&drawn, &blocks);
        for fold in 0..blocks.folds {
            let is_left = |t: usize| blocks.rows_of(fold).iter().any(|rows| rows.contains(&t));
            for set in 0..2 {
                let sum = |left: bool, of: &dyn Fn(f64, f64) -> f64| -> f64 {
                    let rows = (0..240).filter(|&t| is_left(t) == left);
                    rows.map(|t| of(column[(t, 0)], drawn[(t, set)])).sum()
                };
                let slope = sum(false, &|x, y| x * y) / sum(false, &|x, _| x * x);
                let gain = |left: bool| sum(left, &|x, y| y * y - (y - slope * x).powi(2));
                let [kept, left] = [false, true].map(gain);
                assert!((found[fold][set].0 - kept).abs() < 1e-4 * kept.abs(), "{fold}: {:?} {kept}", found[fold][set]);
                assert!((found[fold][set].1 - left).abs() < 1e-4, "{fold}: {:?} {left}", found[fold][set]);
            }
        }
    }

    /// Oracle: of white noise a single column takes away about 1/N by chance, and hardly ever ten times as much; candidates that
    /// are many take away more.
    #[test]
    fn more_candidates_gain_more_by_chance() {
        let names: Vec<String> = (0..12).map(|c| format!("c{c}")).collect();
        let contexts: Vec<&str> = names.iter().map(String::as_str).collect();
        let rig = bench::rig(&["q"], &contexts, &["y"]);
        let samples = bench::time().len();
        let q = (0..samples).map(number).collect();
        let drawn = (0..contexts.len()).map(|c| (0..samples).map(|t| number(9000 * (c + 1) + t)).collect()).collect();
        let y = (0..samples).map(|t| number(500_000 + 5 * t)).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], drawn, vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let bare = State::bare(Form::LINEAR);
        let candidate = |c: usize| {
            let term = bench::placed("context_term", Carrier::Context(c), &rig, &[1.0]);
            Candidate { label: term.label(&rig), states: vec![bare.with(term)], each: None }
        };
        let all: Vec<Candidate> = (0..contexts.len()).map(candidate).collect();
        let draws = Draws { count: 24, family_wise: 0.01, seed: 1 };
        let quantile = |candidates: &[Candidate]| largest_by_chance(&problem, &bare, &bare, candidates, draws).unwrap();
        let (one, many) = (samples as f64 * quantile(&all[..1]), samples as f64 * quantile(&all));
        assert!((1.0..12.0).contains(&one), "{one}");
        assert!(many > one && many < 20.0, "{many} of twelve, {one} of one");
    }
}
