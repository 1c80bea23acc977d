//! Covariance of nonlinear and linear parameters by the sandwich over blocks.
//!
//! ```text
//! C = B/(B−1) H⁻¹ (Σ_b s_b s_bᵀ) H⁻¹,   H = DᵀD,   s_b = D_bᵀ r_b,   value ± t_{B−1} √C_kk
//! ```
//!
//! | symbol | meaning                                                                             | shape |
//! | `D`    | slopes of the residual, what the other columns of the regression explain taken out   | n r × k |
//! | `r`    | residual                                                                            | n r   |
//! | `B`    | number of blocks                                                                    |       |
//!
//! Where several sets of effects predict alike, the interval of a parameter spans those of all that have it. Residuals may be
//! correlated within a block. Liang & Zeger (1986), Biometrika 73(1); Frisch & Waugh (1933) for the columns
//! that are taken out.

use acm_core::rig::Rig;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::design::{Design, design};
use super::problem::Problem;
use super::projected::project;
use super::refine::{Coordinate, Place, places, put};
use super::state::{Part, State};

/// Standard errors of one state's parameters.
#[derive(Debug, Clone)]
pub struct Intervals {
    /// Intervals of each effect, one pair of bounds for each parameter; none for a fixed parameter.
    pub effects: Vec<Vec<Option<[f64; 2]>>>,
    /// Interval of the clock correction.
    pub clock: Option<[f64; 2]>,
}

impl Intervals {
    /// Widens the intervals to include those of another state, for effects that both have: it is not known which of the
    /// two holds.
    pub fn span(&mut self, own: (&State, &Rig), other: &State, theirs: &Intervals) {
        let (state, rig) = own;
        for (mine, placed) in self.effects.iter_mut().zip(&state.effects) {
            let same = other.effects.iter().position(|other| other.label(rig) == placed.label(rig));
            let Some(same) = same else { continue };
            mine.iter_mut().zip(&theirs.effects[same]).for_each(|(mine, theirs)| *mine = hull(*mine, *theirs));
        }
        self.clock = hull(self.clock, theirs.clock);
    }
}

fn hull(one: Option<[f64; 2]>, other: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let both = |one: [f64; 2], other: [f64; 2]| [one[0].min(other[0]), one[1].max(other[1])];
    one.map(|one| other.map_or(one, |other| both(one, other)))
}

/// A linear parameter: effect, index of the parameter, column of the design, column of the target, factor to SI.
struct Linear {
    effect: usize,
    parameter: usize,
    column: usize,
    target: usize,
    factor: f64,
    value: f64,
}

/// Returns the 95 % intervals of all parameters of a state; none where the regression is singular.
pub fn intervals(problem: &Problem, state: &State) -> Option<Intervals> {
    let fitted = project(problem, state)?;
    let linear = linear(problem, state, &fitted.beta, &fitted.design);
    let moved = places(state);
    let coordinates: Vec<Coordinate> = moved.iter().map(|place| Coordinate::new(problem, state, *place)).collect();
    let (n, r) = fitted.residual.shape();
    let others: Vec<usize> = (0..fitted.design.x.ncols()).filter(|c| linear.iter().all(|l| l.column != *c)).collect();
    let without = Projection::new(&fitted.design, &others);
    let mut d = DMatrix::zeros(n * r, coordinates.len() + linear.len());
    for (k, coordinate) in coordinates.iter().enumerate() {
        let mut u = vec![1.0; coordinates.len()];
        u[k] += coordinate.step;
        let next = design(problem, &put(state, &coordinates, &u));
        let change = (&next.y - &next.x * &fitted.beta - &fitted.residual) / coordinate.step;
        d.column_mut(k).copy_from_slice(without.of(change).as_slice());
    }
    for (k, one) in linear.iter().enumerate() {
        let mut change = DMatrix::zeros(n, r);
        change.column_mut(one.target).copy_from(&-fitted.design.x.column(one.column));
        d.column_mut(coordinates.len() + k).copy_from_slice(without.of(change).as_slice());
    }
    let deviations = sandwich(&d, &fitted.residual, &problem.blocks.rows);
    let t = StudentsT::new(0.0, 1.0, (problem.blocks.len() as f64 - 1.0).max(1.0))
        .map_or(f64::INFINITY, |t| t.inverse_cdf(0.975));
    let mut all =
        Intervals { effects: state.effects.iter().map(|placed| vec![None; placed.theta.len()]).collect(), clock: None };
    for ((place, coordinate), deviation) in moved.iter().zip(&coordinates).zip(&deviations) {
        let bounds = [-1.0, 1.0].map(|sign| coordinate.value(1.0 + sign * t * deviation));
        match place {
            Place::Clock => all.clock = Some(bounds),
            Place::Effect(i, j) => all.effects[*i][*j] = Some(bounds),
        }
    }
    for (one, deviation) in linear.iter().zip(&deviations[coordinates.len()..]) {
        let reach = t * deviation * one.factor;
        all.effects[one.effect][one.parameter] = Some([one.value - reach, one.value + reach]);
    }
    Some(all)
}

/// Returns the linear parameters of a state with their values from β.
fn linear(problem: &Problem, state: &State, beta: &DMatrix<f64>, design: &Design) -> Vec<Linear> {
    let width = problem.outputs();
    let additive: Vec<(usize, Vec<usize>)> = state
        .effects
        .iter()
        .enumerate()
        .filter(|(_, placed)| placed.part() == Part::Additive)
        .map(|(i, placed)| (i, placed.linear()))
        .collect();
    let columns: usize = additive.iter().map(|(_, all)| all.len() / width).sum();
    let mut column = design.x.ncols() - columns;
    let mut found = Vec::new();
    for (effect, all) in additive {
        for (l, &parameter) in all.iter().enumerate() {
            let (target, factor) = (l % width, 1.0 / problem.weight[l % width]);
            let at = column + l / width;
            found.push(Linear { effect, parameter, column: at, target, factor, value: beta[(at, target)] * factor });
        }
        column += all.len() / width;
    }
    found
}

/// Returns the state with its linear parameters as β has them.
pub fn with_linear(problem: &Problem, state: &State, beta: &DMatrix<f64>, design: &Design) -> State {
    let mut next = state.clone();
    for one in linear(problem, state, beta, design) {
        let mut placed = (*next.effects[one.effect]).clone();
        placed.theta[one.parameter] = one.value;
        next.effects[one.effect] = std::sync::Arc::new(placed);
    }
    next
}

/// Projection that removes what some columns of a design explain.
struct Projection {
    x: DMatrix<f64>,
    inverse: Option<DMatrix<f64>>,
}

/// Relative size of the columns' directions that count as determined.
const RANK: f64 = 1e-10;

impl Projection {
    fn new(design: &Design, columns: &[usize]) -> Self {
        let x = design.x.select_columns(columns);
        let scale: Vec<f64> = x.column_iter().map(|x| x.norm().max(f64::MIN_POSITIVE)).collect();
        let mut scaled = x;
        scaled.column_iter_mut().zip(&scale).for_each(|(mut x, scale)| x /= *scale);
        let normal = scaled.tr_mul(&scaled);
        let inverse = if columns.is_empty() { None } else { normal.pseudo_inverse(RANK).ok() };
        Self { x: scaled, inverse }
    }

    fn of(&self, d: DMatrix<f64>) -> DMatrix<f64> {
        match &self.inverse {
            Some(inverse) => &d - &self.x * (inverse * self.x.tr_mul(&d)),
            None => d,
        }
    }
}

/// Computes √C_kk.
fn sandwich(d: &DMatrix<f64>, residual: &DMatrix<f64>, blocks: &[std::ops::Range<usize>]) -> Vec<f64> {
    let (n, r) = residual.shape();
    let scale: Vec<f64> = d.column_iter().map(|d| d.norm().max(f64::MIN_POSITIVE)).collect();
    let mut scaled = d.clone();
    scaled.column_iter_mut().zip(&scale).for_each(|(mut d, scale)| d /= *scale);
    let k = d.ncols();
    if k == 0 {
        return vec![];
    }
    let Ok(inverse) = scaled.tr_mul(&scaled).pseudo_inverse(RANK) else { return vec![f64::INFINITY; k] };
    let mut meat = DMatrix::zeros(k, k);
    for rows in blocks {
        let mut s = DVector::zeros(k);
        for o in 0..r {
            let part = scaled.rows(o * n + rows.start, rows.len());
            s += part.tr_mul(&residual.column(o).rows(rows.start, rows.len()));
        }
        meat += &s * s.transpose();
    }
    let b = blocks.len() as f64;
    let covariance = &inverse * meat * &inverse * (b / (b - 1.0).max(1.0));
    (0..k).map(|j| covariance[(j, j)].max(0.0).sqrt() / scale[j]).collect()
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: by hand. The other set has the lag and not the play; its delay is no part of this one.
    #[test]
    fn intervals_span_those_of_a_set_that_predicts_alike() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let placed = |name: &str| bench::placed(name, Carrier::Rig, &rig, &[0.1]);
        let own = State::bare(Form::LINEAR).with(placed("backlash")).with(placed("actuator_lag"));
        let other = State::bare(Form::LINEAR).with(placed("dead_time")).with(placed("actuator_lag"));
        let of = |effects: [[f64; 2]; 2]| Intervals { effects: effects.map(|i| vec![Some(i)]).to_vec(), clock: None };
        let mut bounds = of([[1.0, 2.0], [3.0, 4.0]]);
        bounds.span((&own, &rig), &other, &of([[0.0, 9.0], [2.5, 3.5]]));
        assert_eq!(bounds.effects, of([[1.0, 2.0], [2.5, 4.0]]).effects);
    }

    /// Oracle: the standard error of a mean over blocks of one value each, by the textbook.
    #[test]
    fn the_sandwich_of_a_mean() {
        let y = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
        let mean = y.iter().sum::<f64>() / 6.0;
        let residual = DMatrix::from_fn(6, 1, |k, _| y[k] - mean);
        let d = DMatrix::from_element(6, 1, -1.0);
        let blocks: Vec<std::ops::Range<usize>> = (0..6).map(|k| k..k + 1).collect();
        let variance = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / 5.0;
        assert!((sandwich(&d, &residual, &blocks)[0] - (variance / 6.0).sqrt()).abs() < 1e-12);
    }
}
