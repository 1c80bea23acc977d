//! Fit of a set of effects together with the calibration.

use acm_core::effects::instance::Instance;
use nalgebra::DVector;

use super::descent::Descent;
use super::evaluate::{Point, Tip};
use super::normal::Block;
use super::setup::Setup;

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

impl Fitted {
    /// The fitted point.
    pub fn point(&self) -> Point<'_> {
        Point { instances: &self.instances, theta: &self.theta, delta: &self.delta }
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
