//! Share of one effect that another imitates.
//!
//! ```text
//! predicted:   min over dθ, δ of ‖d_a − D_k − J_k dθ − J δ‖² + prior,   at each anchor θ_k, by normal equations
//! fitted:      min over θ of min over δ of ‖d_a − d(θ) − J δ‖² + prior,   from the best anchors
//! ```
//!
//! | symbol | meaning                                                      | shape  |
//! | `D_k, J_k` | what the imitator does at an anchor, and its slopes      | NM, NM × n |
//! | `θ_k`  | some initial guesses of the imitator, and its values at the common size | n |
//!
//! Anchors do not depend on the effect to be imitated, so they are evaluated once for all rows of the matrix. Imitations that are
//! predicted to be poor are not fitted.

use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};

use super::anchor::{Anchor, Step};
use super::planted::Planted;
use super::projected::Projected;
use super::recalibration::Recalibration;
use super::trials::Trials;

/// An effect, ready to imitate all others.
#[derive(Debug, Clone)]
pub struct Imitator {
    instance: Instance,
    anchors: Vec<Anchor>,
}

/// Predicted share below which an imitation is not fitted.
const WORTH_FITTING: f64 = 0.3;

/// Initial guesses that become anchors.
const GUESSES: usize = 6;

/// Number of anchors that are fitted.
const FITS: usize = 2;

/// A fit that comes this close to what was predicted needs no second one.
const AS_PREDICTED: f64 = 0.02;

impl Imitator {
    /// Prepares the anchors. `others`: displacement of the outputs by each row of the matrix, NM × rows.
    pub fn new(trials: &Trials, planted: &Planted, others: &DMatrix<f64>) -> Self {
        let instance = planted.instance.clone();
        let mut points = thinned(instance.initial_guesses(&trials.prepared.case.rig));
        points.push(planted.theta.clone());
        points.push(mirrored(&instance, &planted.theta));
        points.dedup();
        let anchors = points.into_iter().map(|theta| Anchor::new(trials, &instance, theta, others)).collect();
        Self { instance, anchors }
    }

    /// Returns the share of effect `a`, whose displacement is `original`, that this one imitates.
    pub fn imitates(&self, trials: &Trials, a: usize, original: &DVector<f64>, by: &Recalibration) -> f64 {
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
            let problem = Projected { trials, instance: &self.instance, original, by, start: &step.theta };
            let (cost, without_prior) = problem.fitted();
            if cost < least {
                (least, left) = (cost, without_prior);
            }
            if least <= best.cost + AS_PREDICTED * kept * by.whole {
                break;
            }
        }
        share(left)
    }
}

/// Returns at most [`GUESSES`] of them, evenly, first and last among them.
fn thinned(guesses: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    match guesses.len() {
        length if length <= GUESSES => guesses,
        length => (0..GUESSES).map(|k| guesses[k * (length - 1) / (GUESSES - 1)].clone()).collect(),
    }
}

/// Returns the values with their signs reversed, where that is possible.
fn mirrored(instance: &Instance, theta: &[f64]) -> Vec<f64> {
    let turned = |(spec, value): (&acm_core::effects::ParameterSpec, &f64)| {
        if spec.may_vary { spec.inside(2.0 * spec.neutral - value) } else { *value }
    };
    instance.parameters().iter().zip(theta).map(turned).collect()
}
