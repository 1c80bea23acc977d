//! How much of one effect another imitates.
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
//! Anchors know nothing of what they are to imitate, so they are evaluated once for all rows of the matrix. What is
//! predicted to be imitated badly is not fitted. Fits are those of [`acm_core::levenberg_marquardt`]; recalibration is
//! projected out at every point. Golub & Pereyra (2003), Inverse Problems 19(2).

use std::ops::Range;

use acm_core::effects::instance::Instance;
use acm_core::least_squares::Residuals;
use acm_core::levenberg_marquardt::{Bounds, Options, fit};
use nalgebra::{DMatrix, DVector};

use super::displacement::{displacement, free, with_slopes};
use super::planted::Planted;
use super::recalibration::Recalibration;
use super::start::forget_start;
use super::trials::Trials;
use crate::tall::product;

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
    /// Sum of squares that is left, prior included, and without it.
    cost: f64,
    left: f64,
}

/// What is predicted to imitate less than this of what recalibration leaves is not fitted.
const WORTH_FITTING: f64 = 0.3;

/// Added to the diagonal of scaled normal equations.
const RIDGE: f64 = 1e-6;

/// Initial guesses that become anchors.
const GUESSES: usize = 6;

/// Anchors that are fitted.
const FITS: usize = 2;

/// When a fit ends: its share is to be known to a hundredth or so.
const ENDS: Options = Options { iterations: 5, cost: 1e-3, step: 1e-2, gradient: 1e-2, radius: 10.0 };

/// A fit that comes this close to what was predicted needs no second one.
const AS_PREDICTED: f64 = 0.02;

impl Imitator {
    /// `others`: what each row of the matrix does to the outputs, NM × rows.
    pub fn new(trials: &Trials, planted: &Planted, others: &DMatrix<f64>) -> Self {
        let instance = planted.instance.clone();
        let mut points = thinned(instance.initial_guesses(&trials.prepared.case.rig));
        points.push(planted.theta.clone());
        points.push(mirrored(&instance, &planted.theta));
        points.dedup();
        let anchors = points.into_iter().map(|theta| Anchor::new(trials, &instance, theta, others)).collect();
        Self { instance, anchors }
    }

    /// Share of effect `a`, which does `original` to the outputs, that this one takes over.
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
        let problem = Imitation { trials, instance: &self.instance, free: free(&self.instance), original, by };
        for step in steps.iter().take(FITS) {
            let (cost, without_prior) = problem.fit(&step.theta);
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

/// The residual of one effect under another with recalibration as a least-squares problem: one sample with all NM + P residuals.
struct Imitation<'i> {
    trials: &'i Trials<'i>,
    instance: &'i Instance,
    free: Vec<usize>,
    original: &'i DVector<f64>,
    by: &'i Recalibration,
}

impl Imitation<'_> {
    /// From values on: the sum of squares that is left, prior included, and without it.
    fn fit(&self, theta: &[f64]) -> (f64, f64) {
        let specs = self.instance.parameters();
        let of = |value: &dyn Fn(usize) -> f64| self.free.iter().map(|&j| value(j)).collect::<Vec<f64>>();
        let bounds = Bounds { lower: of(&|j| specs[j].lower), upper: of(&|j| specs[j].upper) };
        let problem = Started { imitation: self, theta };
        let ended = fit(&problem, &of(&|j| theta[j]), &bounds, &ENDS);
        let left = problem.left(&ended.theta, false);
        (ended.cost, left.rows(0, self.trials.rows()).norm_squared())
    }
}

/// With the values that do not move.
struct Started<'i> {
    imitation: &'i Imitation<'i>,
    theta: &'i [f64],
}

impl Started<'_> {
    /// What is left, and beside it its slopes where they are asked for.
    fn left(&self, values: &[f64], sloped: bool) -> DMatrix<f64> {
        let Imitation { trials, instance, free, original, by } = self.imitation;
        let mut theta = self.theta.to_vec();
        free.iter().zip(values).for_each(|(&j, value)| theta[j] = *value);
        let mut columns = match sloped {
            true => with_slopes(trials, instance, &theta),
            false => DMatrix::from_column_slice(trials.rows(), 1, displacement(trials, instance, &theta).as_slice()),
        };
        columns.neg_mut();
        let mut first = columns.column_mut(0);
        first += *original;
        forget_start(trials, instance, &theta, &mut columns);
        by.without(trials, &columns)
    }
}

impl Residuals for Started<'_> {
    fn parameters(&self) -> usize {
        self.imitation.free.len()
    }

    fn samples(&self) -> usize {
        1
    }

    fn outputs(&self) -> usize {
        self.imitation.trials.rows() + self.imitation.trials.calibrated()
    }

    fn residuals(&self, theta: &[f64], _: Range<usize>, out: &mut [f64]) {
        out.copy_from_slice(self.left(theta, false).as_slice());
    }

    fn slopes(&self, theta: &[f64], _: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        let left = self.left(theta, true);
        out.copy_from_slice(left.column(0).as_slice());
        slopes.copy_from(&left.columns(1, theta.len()));
    }
}

impl Anchor {
    fn new(trials: &Trials, instance: &Instance, theta: Vec<f64>, others: &DMatrix<f64>) -> Self {
        let mut both = with_slopes(trials, instance, &theta);
        forget_start(trials, instance, &theta, &mut both);
        let of = |other: &DMatrix<f64>| product(other, &both, 0..trials.rows());
        Self { own: of(&both), calibration: of(&trials.by_parameter), others: of(others).transpose(), theta }
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

/// Of normal equations scaled to unit diagonal, with a ridge that holds directions that the data do not determine.
fn solution(normal: DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let scale = normal.diagonal().map(|x| if x > 0.0 { 1.0 / x.sqrt() } else { 0.0 });
    let mut scaled = DMatrix::from_fn(scale.len(), scale.len(), |a, b| normal[(a, b)] * scale[a] * scale[b]);
    (0..scale.len()).for_each(|a| scaled[(a, a)] += RIDGE);
    let solved = scaled.cholesky().map(|factor| factor.solve(&right.component_mul(&scale)));
    solved.map_or_else(|| DVector::zeros(scale.len()), |solved| solved.component_mul(&scale))
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
