//! Levenberg–Marquardt within the bounds of each parameter, step by step.
//!
//! ```text
//! (H + λ diag H) d = −g,   λ ← 10 λ where the cost would rise,   λ ← λ/10 where it fell
//! ```
//!
//! | symbol | meaning                                             | unit            |
//! | `H, g` | normal equations with the prior ([`crate::separability::normal`]) | of cost per θ   |
//! | `λ`    | damping                                             | 1               |
//!
//! Normal equations are what a step costs, so they are made where one begins, and not where a search stops. Marquardt (1963),
//! SIAM Journal 11(2).

use acm_core::effects::instance::Instance;
use nalgebra::DVector;
use rayon::prelude::*;

use crate::separability::equations::{blocks, whole, with_prior};
use crate::separability::evaluate::{self, Point, StateFrom, Tip, free};
use crate::separability::joint::Fitted;
use crate::separability::normal::step;
use crate::separability::setup::Setup;

/// Share of the cost below which a step was the last.
const LEAST_GAIN: f64 = 1e-4;

/// Dampings that a step tries.
const DAMPINGS: usize = 6;

/// A fit on its way.
#[derive(Debug, Clone)]
pub(crate) struct Descent {
    /// Without normal equations, which are only needed block by block at the end.
    at: Fitted,
    tip: Tip,
    damping: f64,
    has_ended: bool,
}

impl Descent {
    /// Before the first step; the cost is known after it.
    pub fn new(instances: &[Instance], start: &[Vec<f64>], delta: &DVector<f64>, tip: Tip) -> Self {
        let theta = clamped(instances, start);
        let at = Fitted { instances: instances.to_vec(), theta, delta: delta.clone(), cost: f64::NAN, blocks: vec![] };
        Self { at, tip, damping: 1e-3, has_ended: false }
    }

    /// So many steps further, or to where it ends.
    pub fn steps(mut self, setup: &Setup, count: usize) -> Self {
        for _ in 0..count {
            if self.has_ended {
                break;
            }
            self.step(setup);
        }
        self
    }

    /// With normal equations of each block at the end.
    pub fn end(mut self, setup: &Setup) -> Fitted {
        self.at.blocks = blocks(setup, self.at.point(), self.tip);
        self.note_first_cost(setup, self.at.blocks.iter().map(|block| block.cost).sum());
        self.at
    }

    fn step(&mut self, setup: &Setup) {
        let sum = whole(setup, self.at.point(), self.tip);
        self.note_first_cost(setup, sum.cost);
        let before = self.at.cost;
        let (normal, gradient) = with_prior(setup, sum, &self.at.delta);
        let moves = moves(&self.at, &gradient);
        let lower = (0..DAMPINGS).find_map(|_| {
            let next = moved(&self.at, &step(&normal, &gradient, &moves, self.damping));
            let cost = cost(setup, next.point(), self.tip);
            if cost.is_finite() && cost <= before {
                return Some(Fitted { cost, ..next });
            }
            self.damping *= 10.0;
            None
        });
        let Some(next) = lower else {
            self.has_ended = true;
            return;
        };
        self.damping = (self.damping / 10.0).max(1e-8);
        self.has_ended = (before - next.cost) / before.max(f64::MIN_POSITIVE) < LEAST_GAIN;
        self.at = next;
    }

    fn note_first_cost(&mut self, setup: &Setup, of_residuals: f64) {
        if self.at.cost.is_nan() {
            self.at.cost = of_residuals + prior_cost(setup, &self.at.delta);
        }
    }
}

fn cost(setup: &Setup, point: Point, tip: Tip) -> f64 {
    let parts: Vec<f64> = (0..setup.series.len())
        .into_par_iter()
        .map(|s| evaluate::residual(setup, s, point, tip, StateFrom::Trial).norm_squared())
        .collect();
    parts.iter().sum::<f64>() + prior_cost(setup, point.delta)
}

fn prior_cost(setup: &Setup, delta: &DVector<f64>) -> f64 {
    let away = delta - &setup.centre;
    setup.noise * away.dot(&(&setup.precision * &away))
}

/// Which unknowns a step may change: those that no bound holds against the gradient.
pub(crate) fn moves(fit: &Fitted, gradient: &DVector<f64>) -> Vec<bool> {
    let free = free(&fit.instances);
    let held = |(k, &(i, j)): (usize, &(usize, usize))| {
        let (spec, value) = (&fit.instances[i].parameters()[j], fit.theta[i][j]);
        (value <= spec.lower && gradient[k] > 0.0) || (value >= spec.upper && gradient[k] < 0.0)
    };
    let effects = free.iter().enumerate().map(|pair| !held(pair));
    effects.chain(std::iter::repeat_n(true, fit.delta.len())).collect()
}

/// After a step, within bounds; normal equations are still to be made.
pub(crate) fn moved(fit: &Fitted, step: &DVector<f64>) -> Fitted {
    let free = free(&fit.instances);
    let mut next = Fitted { blocks: vec![], ..fit.clone() };
    for (k, &(i, j)) in free.iter().enumerate() {
        next.theta[i][j] = fit.instances[i].parameters()[j].inside(fit.theta[i][j] + step[k]);
    }
    next.delta += step.rows(free.len(), fit.delta.len());
    next
}

fn clamped(instances: &[Instance], theta: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let inside = |(instance, theta): (&Instance, &Vec<f64>)| {
        instance.parameters().iter().zip(theta).map(|(spec, value)| spec.inside(*value)).collect()
    };
    instances.iter().zip(theta).map(inside).collect()
}
