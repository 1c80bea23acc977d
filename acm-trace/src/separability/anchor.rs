//! Linearisation of an effect around one of its values, and a step towards the effect to be imitated.
//!
//! ```text
//! min over dθ, δ of ‖d_a − D_k − J_k dθ − J δ‖² + prior
//! ```

use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};

use super::displacement::{free, with_slopes};
use super::recalibration::Recalibration;
use super::start::forget_start;
use super::trials::Trials;
use crate::tall::product;

/// Value added to the diagonal of scaled normal equations.
const RIDGE: f64 = 1e-6;

/// Products of [D, J_k] with each other, with the slopes of the calibration, and with the displacements to be imitated.
#[derive(Debug, Clone)]
pub struct Anchor {
    theta: Vec<f64>,
    /// Products with each other, 1 + n square.
    own: DMatrix<f64>,
    /// Products with the slopes of the calibration, P × (1 + n).
    calibration: DMatrix<f64>,
    /// Products with the rows of the matrix, (1 + n) × rows.
    others: DMatrix<f64>,
}

/// End of a linear step from an anchor.
pub struct Step {
    /// Parameters θ.
    pub theta: Vec<f64>,
    /// Sum of squares that is left, prior included.
    pub cost: f64,
    /// Sum of squares that is left, without the prior.
    pub left: f64,
}

impl Anchor {
    /// Returns the products at an anchor. `others`: displacement of the outputs by each row of the matrix, NM × rows.
    pub fn new(trials: &Trials, instance: &Instance, theta: Vec<f64>, others: &DMatrix<f64>) -> Self {
        let mut both = with_slopes(trials, instance, &theta);
        forget_start(trials, instance, &theta, &mut both);
        let of = |other: &DMatrix<f64>| product(other, &both, 0..trials.rows());
        Self { own: of(&both), calibration: of(&trials.by_parameter), others: of(others).transpose(), theta }
    }

    /// Takes one Gauss–Newton step towards effect `a`, within the bounds, with recalibration.
    pub fn step(&self, instance: &Instance, a: usize, by: &Recalibration) -> Step {
        let columns = self.own.nrows();
        let taken = by.solve_all(&self.calibration);
        let own = &self.own - self.calibration.tr_mul(&taken);
        let with = self.others.column(a) - taken.tr_mul(&by.along);
        // The residual of d is d − X c with c = (1, dθ): X holds the anchor's own displacement, then its slopes.
        let right = with.rows(1, columns - 1) - own.view((1, 0), (columns - 1, 1)).column(0);
        let normal = own.view((1, 1), (columns - 1, columns - 1)).into_owned();
        let step = solution(normal, &right.into_owned());
        let mut theta = self.theta.clone();
        let mut coefficients = DVector::zeros(columns);
        coefficients[0] = 1.0;
        for (k, j) in free(instance).into_iter().enumerate() {
            theta[j] = instance.parameters()[j].inside(self.theta[j] + step[k]);
            coefficients[1 + k] = theta[j] - self.theta[j];
        }
        let delta = by.solve(&(&by.along - &self.calibration * &coefficients));
        let start = by.whole - by.along.dot(&by.solve(&by.along));
        let cost = start - 2.0 * with.dot(&coefficients) + coefficients.dot(&(&own * &coefficients));
        Step { theta, left: cost - by.pull(&delta), cost }
    }
}

/// Solves normal equations scaled to unit diagonal, with a ridge for directions that the data do not determine.
fn solution(normal: DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let scale = normal.diagonal().map(|x| if x > 0.0 { 1.0 / x.sqrt() } else { 0.0 });
    let mut scaled = DMatrix::from_fn(scale.len(), scale.len(), |a, b| normal[(a, b)] * scale[a] * scale[b]);
    (0..scale.len()).for_each(|a| scaled[(a, a)] += RIDGE);
    let solved = scaled.cholesky().map(|factor| factor.solve(&right.component_mul(&scale)));
    solved.map_or_else(|| DVector::zeros(scale.len()), |solved| solved.component_mul(&scale))
}
