//! Fit of a set of effects together with the calibration, and its scores on blocks left out.
//!
//! Leaving a block out takes one Gauss–Newton step from the optimum without that block's normal equations; the block is then
//! predicted by the true model.

use std::collections::BTreeMap;

use acm_core::effects::instance::Instance;
use nalgebra::DVector;
use rayon::prelude::*;

use crate::descent::{Descent, moved, moves};
use crate::equations::total;
use crate::evaluate::{self, Point, StateFrom, Tip, free};
use crate::normal::{Block, step};
use crate::setup::{Setup, ranges};

/// A fitted set of effects.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// In the order of action.
    pub instances: Vec<Instance>,
    /// θ of each.
    pub theta: Vec<Vec<f64>>,
    /// δ.
    pub delta: DVector<f64>,
    /// Σ‖r‖²/σ² and the prior, times σ².
    pub cost: f64,
    /// Normal equations at the optimum.
    pub blocks: Vec<Block>,
}

/// A fit with its scores on blocks left out.
#[derive(Debug, Clone)]
pub struct Scored {
    /// The fit.
    pub fit: Fitted,
    /// Mean square of each block left out, summed over outputs.
    pub left_out: Vec<f64>,
    /// Residual of each trial, each block predicted without itself [N×M], weighted.
    pub residual: Vec<DVector<f64>>,
    /// θ without each block: `[block][effect][parameter]`.
    pub jackknife: Vec<Vec<Vec<f64>>>,
}

impl Fitted {
    /// Number of effect parameters that the fit moved.
    pub fn parameters(&self) -> usize {
        free(&self.instances).len()
    }

    /// Whether a value of effect `i` rests on a bound of what the effect admits.
    pub fn rests_on_bound_at(&self, i: usize) -> bool {
        self.instances[i].parameters().iter().zip(&self.theta[i]).any(|(spec, value)| spec.is_at_bound(*value))
    }

    /// Whether a value of any effect does.
    pub fn rests_on_bound(&self) -> bool {
        (0..self.instances.len()).any(|i| self.rests_on_bound_at(i))
    }

    /// The fitted point.
    pub fn point(&self) -> Point<'_> {
        Point { instances: &self.instances, theta: &self.theta, delta: &self.delta }
    }
}

impl Scored {
    /// Mean over blocks of the mean square left out.
    pub fn mean_square(&self) -> f64 {
        self.left_out.iter().sum::<f64>() / self.left_out.len().max(1) as f64
    }
}

/// Fits from a start; `iterations` at most.
pub fn fit(
    setup: &Setup,
    instances: &[Instance],
    start: &[Vec<f64>],
    delta: &DVector<f64>,
    tip: Tip,
    iterations: usize,
) -> Fitted {
    Descent::new(instances, start, delta, tip).steps(setup, iterations).end(setup)
}

/// Leaves each block out in turn.
pub fn score(setup: &Setup, fit: Fitted, tip: Tip) -> Scored {
    let (normal, gradient) = total(setup, &fit.blocks, &fit.delta);
    let moves = moves(&fit, &gradient);
    let without: Vec<Fitted> = fit
        .blocks
        .iter()
        .map(|block| moved(&fit, &step(&(&normal - &block.normal), &(&gradient - &block.gradient), &moves, 1e-9)))
        .collect();
    let parts: Vec<Vec<(usize, DVector<f64>)>> = (0..setup.series.len())
        .into_par_iter()
        .map(|s| {
            let width = setup.outputs();
            // A block may be many ranges of a trial, and the trial is predicted once for all of them.
            let mut predicted: BTreeMap<usize, DVector<f64>> = BTreeMap::new();
            let of = |(block, rows): (usize, std::ops::Range<usize>)| {
                let all = predicted
                    .entry(block)
                    .or_insert_with(|| evaluate::residual(setup, s, without[block].point(), tip, StateFrom::WarmUp));
                (block, all.rows(rows.start * width, rows.len() * width).into_owned())
            };
            ranges(&setup.series[s]).into_iter().map(of).collect()
        })
        .collect();
    let mut squares = vec![0.0; fit.blocks.len()];
    let mut residual = Vec::new();
    for part in parts {
        part.iter().for_each(|(block, r)| squares[*block] += r.norm_squared());
        residual.push(DVector::from_iterator(
            part.iter().map(|(_, r)| r.len()).sum(),
            part.iter().flat_map(|(_, r)| r.iter().copied()),
        ));
    }
    let left_out = squares.iter().zip(&fit.blocks).map(|(sum, block)| sum / block.count.max(1) as f64).collect();
    Scored { left_out, residual, jackknife: without.into_iter().map(|fit| fit.theta).collect(), fit }
}
