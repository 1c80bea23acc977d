//! How much of one effect another imitates.
//!
//! ```text
//! predicted:   min over dθ of ‖d_a − D_k − J_k dθ − J δ‖² + prior,   at each anchor θ_k, by normal equations
//! fitted:      from the best anchors, by Levenberg–Marquardt
//! ```
//!
//! | symbol | meaning                                                      | shape  |
//! | `D_k, J_k` | what the imitator does at an anchor, and its slopes      | NM, NM × n |
//! | `θ_k`  | some initial guesses of the imitator, and its values at the common size | n |
//!
//! Anchors know nothing of what they are to imitate, so they are evaluated once for all rows of the matrix. What is
//! predicted to be imitated badly is not fitted.

use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};

use super::alone;
use super::planted::Planted;
use super::recalibration::Recalibration;
use crate::separability::evaluate::{self, Tip, free};
use crate::separability::joint::fit;
use crate::separability::setup::Setup;

/// An effect, ready to imitate all others.
#[derive(Debug, Clone)]
pub struct Imitator {
    instance: Instance,
    anchors: Vec<Anchor>,
}

/// Products of [D, J_k] with each other, with the slopes of the calibration, and with what is to be imitated.
#[derive(Debug, Clone)]
struct Anchor {
    theta: Vec<f64>,
    /// 1 + n square.
    own: DMatrix<f64>,
    /// P × (1 + n).
    calibration: DMatrix<f64>,
    /// (1 + n) × rows of the matrix.
    others: DMatrix<f64>,
}

/// Where a linear step from an anchor ends.
struct Step {
    theta: Vec<f64>,
    delta: DVector<f64>,
    /// Sum of squares that is left, prior included, and without it.
    cost: f64,
    left: f64,
}

/// What is predicted to imitate less than this of what recalibration leaves is not fitted.
const WORTH_FITTING: f64 = 0.3;

/// Initial guesses that become anchors.
const GUESSES: usize = 6;

/// Anchors that are fitted.
const FITS: usize = 2;

/// Steps of a fit.
const STEPS: usize = 5;

/// A fit that comes this close to what was predicted needs no second one.
const AS_PREDICTED: f64 = 0.02;

impl Imitator {
    /// `others`: what each row of the matrix does to the outputs.
    pub fn new(setup: &Setup, planted: &Planted, others: &[&[DVector<f64>]]) -> Self {
        let instance = planted.instance.clone();
        let mut points = thinned(instance.initial_guesses(setup.rig));
        points.push(planted.theta.clone());
        points.push(mirrored(&instance, &planted.theta));
        points.dedup();
        let anchors = points.into_iter().map(|theta| Anchor::new(setup, &instance, theta, others)).collect();
        Self { instance, anchors }
    }

    /// Share of effect `a` that this one takes over in `setup`, whose outputs are those of the model with effect a.
    pub fn imitates(&self, setup: &Setup, a: usize, by: &Recalibration) -> f64 {
        let mut steps: Vec<Step> = self.anchors.iter().map(|anchor| anchor.step(&self.instance, a, by)).collect();
        steps.sort_by(|one, other| one.cost.total_cmp(&other.cost));
        let Some(best) = steps.first() else { return by.share };
        let share = |left: f64| (1.0 - left / by.whole).clamp(by.share, 1.0);
        let kept = 1.0 - by.share;
        if share(best.left) - by.share < WORTH_FITTING * kept {
            return share(best.left);
        }
        let (mut least, mut left) = (f64::INFINITY, by.whole);
        for step in steps.iter().take(FITS) {
            let start = vec![step.theta.clone()];
            let instances = std::slice::from_ref(&self.instance);
            let fitted = fit(setup, instances, &start, &step.delta, Tip::Linear, STEPS);
            if fitted.cost < least {
                least = fitted.cost;
                left = fitted.blocks.iter().map(|block| block.cost).sum();
            }
            if least <= best.cost + AS_PREDICTED * kept * by.whole {
                break;
            }
        }
        share(left)
    }
}

impl Anchor {
    fn new(setup: &Setup, instance: &Instance, theta: Vec<f64>, others: &[&[DVector<f64>]]) -> Self {
        let (values, zero) = (vec![theta.clone()], DVector::zeros(setup.calibrated()));
        let point = alone(instance, &values, &zero);
        let columns = 1 + free(std::slice::from_ref(instance)).len();
        let mut own = DMatrix::zeros(columns, columns);
        let mut calibration = DMatrix::zeros(setup.calibrated(), columns);
        let mut products = DMatrix::zeros(columns, others.len());
        for s in 0..setup.series.len() {
            let sloped = evaluate::sloped(setup, s, point, Tip::Linear);
            // Residuals fall where outputs rise.
            let mut both = DMatrix::zeros(sloped.residual.len(), columns);
            both.column_mut(0).copy_from(&-&sloped.residual);
            both.columns_mut(1, columns - 1).copy_from(&-&sloped.by_theta);
            own += both.tr_mul(&both);
            calibration -= setup.references[s].by_parameter.tr_mul(&both);
            for (a, other) in others.iter().enumerate() {
                let mut column = products.column_mut(a);
                column += both.tr_mul(&other[s]);
            }
        }
        Self { theta, own, calibration, others: products }
    }

    /// One Gauss–Newton step towards effect `a`, within the bounds, with recalibration.
    fn step(&self, instance: &Instance, a: usize, by: &Recalibration) -> Step {
        let columns = self.own.nrows();
        let taken = by.solve_all(&self.calibration);
        let own = &self.own - self.calibration.tr_mul(&taken);
        let with = self.others.column(a) - taken.tr_mul(&by.along);
        // What is left of d is d − X c with c = (1, dθ): X holds the anchor's own displacement, then its slopes.
        let right = with.rows(1, columns - 1) - own.view((1, 0), (columns - 1, 1)).column(0);
        let normal = own.view((1, 1), (columns - 1, columns - 1)).into_owned();
        let moves = vec![true; columns - 1];
        let step = crate::separability::normal::step(&normal, &-right, &moves, 1e-6);
        let mut theta = self.theta.clone();
        let mut coefficients = DVector::zeros(columns);
        coefficients[0] = 1.0;
        for (k, (_, j)) in free(std::slice::from_ref(instance)).into_iter().enumerate() {
            theta[j] = instance.parameters()[j].inside(self.theta[j] + step[k]);
            coefficients[1 + k] = theta[j] - self.theta[j];
        }
        let delta = by.solve(&(&by.along - &self.calibration * &coefficients));
        let start = by.whole - by.along.dot(&by.solve(&by.along));
        let cost = start - 2.0 * with.dot(&coefficients) + coefficients.dot(&(&own * &coefficients));
        Step { theta, left: cost - by.pull(&delta), delta, cost }
    }
}

/// At most [`GUESSES`] of them, evenly, first and last among them.
fn thinned(guesses: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    match guesses.len() {
        length if length <= GUESSES => guesses,
        length => (0..GUESSES).map(|k| guesses[k * (length - 1) / (GUESSES - 1)].clone()).collect(),
    }
}

/// The same with its sizes turned around, where they may be.
fn mirrored(instance: &Instance, theta: &[f64]) -> Vec<f64> {
    let turned = |(spec, value): (&acm_core::effects::ParameterSpec, &f64)| {
        if spec.may_vary { spec.inside(2.0 * spec.neutral - value) } else { *value }
    };
    instance.parameters().iter().zip(theta).map(turned).collect()
}
