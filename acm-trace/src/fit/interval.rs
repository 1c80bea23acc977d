//! Intervals of nonlinear and linear parameters by the jackknife over blocks.
//!
//! ```text
//! σ² = (B − 1)/B Σ_b (θ_(b) − θ̄)²,   θ ± t_{B−1} σ
//! ```
//!
//! | symbol  | meaning                                                                                          |
//! | `θ_(b)` | estimate without block b: all linear parameters solved for again, the others to first order       |
//! | `θ̄`     | mean of these                                                                                     |
//! | `B`     | number of blocks                                                                                  |
//!
//! A parameter that rests on a bound biases the others: intervals include the estimate and the first-order estimate without bounds. Where
//! several sets of effects predict alike, the interval of a parameter spans those of all that have it. Residuals may be correlated within
//! a block. A flexible map fits every block that it has seen, so that residuals of the fit are too small: the jackknife does not use them.
//! Efron & Tibshirani (1993), An Introduction to the Bootstrap, ch. 11.

use acm_core::rig::Rig;
use nalgebra::DMatrix;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::design::{Design, design};
use super::gram::{Coefficients, Grams};
use super::problem::Problem;
use super::projected::{Projected, project};
use super::refine::{Coordinate, Place, places, put};
use super::state::{Part, Placed, State};

/// 95 % intervals of one state's parameters.
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
        for (i, mine) in self.effects.iter_mut().enumerate() {
            // The same effect may act twice, in one of the two sets or in both.
            let same = nearest(&state.effects[i], other, rig);
            let Some(same) = same.filter(|&k| nearest(&other.effects[k], state, rig) == Some(i)) else { continue };
            mine.iter_mut().zip(&theirs.effects[same]).for_each(|(mine, theirs)| *mine = hull(*mine, *theirs));
        }
        self.clock = hull(self.clock, theirs.clock);
    }
}

/// Returns the same effect of a state, of several the one with the nearest values.
fn nearest(placed: &Placed, state: &State, rig: &Rig) -> Option<usize> {
    let distance = |other: &Placed| -> f64 {
        let values = placed.theta.iter().zip(&other.theta).zip(placed.instance.parameters());
        values.map(|((one, other), spec)| ((one - other) / spec.scale).powi(2)).sum()
    };
    let same = (0..state.effects.len()).filter(|&k| state.effects[k].label(rig) == placed.label(rig));
    same.min_by(|&a, &b| distance(&state.effects[a]).total_cmp(&distance(&state.effects[b])))
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
    let Projected { beta, residual, design: mut regression } = project(problem, state)?;
    let linear = linear(problem, state, &beta, &regression);
    let moved = places(state);
    let coordinates: Vec<Coordinate> = moved.iter().map(|place| Coordinate::new(problem, state, *place)).collect();
    let slope = |k: usize| {
        let mut u = vec![1.0; coordinates.len()];
        let step = coordinates[k].step_from(u[k]);
        u[k] += step;
        let next = design(problem, &put(state, &coordinates, &u));
        (&residual - (&next.y - &next.x * &beta)) / step
    };
    regression.coupled = (0..coordinates.len()).into_par_iter().map(slope).collect();
    let blocks = problem.blocks.each_alone();
    let grams = Grams::new(&regression, &blocks);
    let (freed, without) = (grams.solve(state.form.ridge)?, grams.solve_folds(&blocks, state.form.ridge)?);
    let t =
        StudentsT::new(0.0, 1.0, (blocks.len() as f64 - 1.0).max(1.0)).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975));
    let mut all =
        Intervals { effects: state.effects.iter().map(|placed| vec![None; placed.theta.len()]).collect(), clock: None };
    for (k, (place, coordinate)) in moved.iter().zip(&coordinates).enumerate() {
        let moves = regression.coupled[k].amax() > 0.0;
        let deviation = if moves { jackknife(without.iter().map(|one| one.alpha[k])) } else { f64::INFINITY };
        let [low, high] = around([1.0, 1.0 + freed.alpha[k]], t * deviation);
        let bounds = [coordinate.value(low), coordinate.value(high)];
        match place {
            Place::Clock => all.clock = Some(bounds),
            Place::Effect(i, j) => all.effects[*i][*j] = Some(bounds),
        }
    }
    for one in &linear {
        let of = |solved: &Coefficients| solved.beta[(one.column, one.target)];
        let deviation = jackknife(without.iter().map(of));
        let bounds = around([beta[(one.column, one.target)], of(&freed)], t * deviation);
        all.effects[one.effect][one.parameter] = Some(bounds.map(|bound| one.factor * bound));
    }
    Some(all)
}

/// Returns the interval of this reach around two estimates.
fn around([one, other]: [f64; 2], reach: f64) -> [f64; 2] {
    [one.min(other) - reach, one.max(other) + reach]
}

/// Returns the standard error of an estimate from its values without each block.
fn jackknife(without: impl Iterator<Item = f64> + Clone) -> f64 {
    let b = without.clone().count().max(1) as f64;
    let mean = without.clone().sum::<f64>() / b;
    ((b - 1.0) / b * without.map(|one| (one - mean).powi(2)).sum::<f64>()).sqrt()
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

/// Returns the state with its linear parameters from β.
pub fn with_linear(problem: &Problem, state: &State, beta: &DMatrix<f64>, design: &Design) -> State {
    let mut next = state.clone();
    for one in linear(problem, state, beta, design) {
        let mut placed = (*next.effects[one.effect]).clone();
        placed.theta[one.parameter] = one.value;
        next.effects[one.effect] = std::sync::Arc::new(placed);
    }
    next
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;

    /// Oracle: by hand. The other set has the lag, before a delay, and not the play; its delay is no part of this one.
    #[test]
    fn intervals_span_those_of_a_set_that_predicts_alike() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let placed = |name: &str| bench::placed(name, Carrier::Rig, &rig, &[0.1]);
        let own = State::bare(Form::LINEAR).with(placed("backlash")).with(placed("actuator_lag"));
        let other = State::bare(Form::LINEAR).with(placed("dead_time")).with(placed("actuator_lag"));
        let of = |effects: [[f64; 2]; 2]| Intervals { effects: effects.map(|i| vec![Some(i)]).to_vec(), clock: None };
        let mut bounds = of([[1.0, 2.0], [3.0, 4.0]]);
        bounds.span((&own, &rig), &other, &of([[2.5, 3.5], [0.0, 9.0]]));
        assert_eq!(bounds.effects, of([[1.0, 2.0], [2.5, 4.0]]).effects);
    }

    /// Oracle: by hand. Of two creeps each belongs to the one of the nearest time; to one of 33 s the creep of 35 s, and none to that of 1.5 s.
    #[test]
    fn intervals_of_one_effect_twice_span_each_its_own() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let creeps = |taus: &[f64]| {
            let creep = |tau: &f64| bench::placed("creep", Carrier::Rig, &rig, &[0.1, *tau]);
            taus.iter().fold(State::bare(Form::LINEAR), |state, tau| state.with(creep(tau)))
        };
        let of =
            |effects: &[[f64; 2]]| Intervals { effects: effects.iter().map(|i| vec![Some(*i)]).collect(), clock: None };
        let spanned = |other: &[f64], theirs: &[[f64; 2]]| {
            let mut bounds = of(&[[1.0, 2.0], [30.0, 40.0]]);
            bounds.span((&creeps(&[1.5, 35.0]), &rig), &creeps(other), &of(theirs));
            bounds.effects
        };
        assert_eq!(spanned(&[33.0, 1.4], &[[29.0, 39.0], [0.5, 1.8]]), of(&[[0.5, 2.0], [29.0, 40.0]]).effects);
        assert_eq!(spanned(&[33.0], &[[29.0, 39.0]]), of(&[[1.0, 2.0], [29.0, 40.0]]).effects);
    }

    /// Oracle: the standard error of a mean, by the textbook.
    #[test]
    fn the_jackknife_of_a_mean() {
        let y = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
        let (sum, mean) = (y.iter().sum::<f64>(), y.iter().sum::<f64>() / 6.0);
        let variance = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / 5.0;
        assert!((jackknife(y.iter().map(|y| (sum - y) / 5.0)) - (variance / 6.0).sqrt()).abs() < 1e-12);
    }
}
