//! Bounded Levenberg–Marquardt with a trust region.
//!
//! ```text
//! minimise ‖z + R p‖²  subject to  ‖D p‖ ≤ Δ,   D_j = largest norm of column j seen so far
//! ```
//!
//! | symbol | meaning                                        | shape |
//! | `p`    | step in the parameters                         | n     |
//! | `R, z` | the problem at this point, see [`crate::fitting::least_squares`] | n × n, n |
//! | `Δ`    | radius of the region in which the linear model is trusted | 1 |
//!
//! D makes the iteration independent of the parameters' units. The step comes from the singular values
//! of R D⁻¹, so that a direction which the data do not determine gets no step and no standard deviation.
//! A parameter at a bound that the gradient pushes outwards is held; other steps are cut at the bounds.
//! Moré (1978), "The Levenberg–Marquardt algorithm: implementation and theory".

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::fitting::least_squares::{Reduced, Residuals, cost, reduce};
use crate::fitting::trust_region::{Linear, weight};

/// When to stop, and how far to trust the first step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Most iterations.
    pub iterations: usize,
    /// Stop when the sum of squares falls by less than this fraction.
    pub cost: f64,
    /// Stop when a step is shorter than this fraction of the parameters (both scaled by D).
    pub step: f64,
    /// Stop when no column of J has a larger cosine with the residual.
    pub gradient: f64,
    /// First radius as a multiple of the start's scaled norm.
    pub radius: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { iterations: 200, cost: 1e-12, step: 1e-12, gradient: 1e-12, radius: 10.0 }
    }
}

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The sum of squares no longer falls.
    CostConverged,
    /// The parameters no longer move.
    StepConverged,
    /// The residual is orthogonal to all columns of the Jacobian.
    GradientConverged,
    /// Nothing is left to fit.
    ExactFit,
    /// Solved in one go: a linear problem.
    ClosedForm,
    /// Not converged: the iterations ran out.
    IterationLimit,
    /// Not converged: the residuals at the start are not finite.
    NotFinite,
}

impl StopReason {
    /// Whether the fit reached a minimum.
    pub fn converged(&self) -> bool {
        !matches!(self, Self::IterationLimit | Self::NotFinite)
    }
}

/// Smallest and largest value of each parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// Smallest, −∞ where there is none.
    pub lower: Vec<f64>,
    /// Largest, +∞ where there is none.
    pub upper: Vec<f64>,
}

impl Bounds {
    /// No bounds for `n` parameters.
    pub fn none(n: usize) -> Self {
        Self { lower: vec![f64::NEG_INFINITY; n], upper: vec![f64::INFINITY; n] }
    }

    fn clamp(&self, j: usize, value: f64) -> f64 {
        value.max(self.lower[j]).min(self.upper[j])
    }

    /// Whether a step down the gradient would leave the bounds at once.
    fn holds(&self, j: usize, value: f64, gradient: f64) -> bool {
        (value <= self.lower[j] && gradient > 0.0) || (value >= self.upper[j] && gradient < 0.0)
    }
}

/// Where a fit ended.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Parameters.
    pub theta: Vec<f64>,
    /// Sum of squares.
    pub cost: f64,
    /// Iterations: evaluations of the slopes.
    pub iterations: usize,
    /// Why it ended.
    pub stopped: StopReason,
    /// σ²(JᵀJ)⁻¹ with σ² = cost/(rows − n); NaN where the data do not determine a parameter, or
    /// where it rests on a bound.
    pub covariance: DMatrix<f64>,
}

impl Fit {
    /// Standard deviation of each parameter, where it has one.
    pub fn deviations(&self) -> Vec<Option<f64>> {
        let variances = self.covariance.diagonal();
        variances.iter().map(|v| Some(v.sqrt()).filter(|sd| sd.is_finite())).collect()
    }
}

/// Least squares from `start` within `bounds`.
pub fn fit(problem: &impl Residuals, start: &[f64], bounds: &Bounds, options: &Options) -> Fit {
    let mut search = Search::new(problem, start, bounds);
    let stopped = search.run(options);
    Fit {
        covariance: search.covariance(),
        theta: search.theta,
        cost: search.here.cost,
        iterations: search.iterations,
        stopped,
    }
}

/// The parameters that [`fit`] ends at, without their covariance, which takes the slopes once more.
pub fn minimiser(problem: &impl Residuals, start: &[f64], bounds: &Bounds, options: &Options) -> Vec<f64> {
    let mut search = Search::new(problem, start, bounds);
    search.run(options);
    search.theta
}

/// State of one fit.
struct Search<'a, P: Residuals> {
    problem: &'a P,
    bounds: &'a Bounds,
    theta: Vec<f64>,
    /// The cost at `theta`, and the rest where `is_reduced`.
    here: Reduced,
    is_reduced: bool,
    scale: Vec<f64>,
    radius: f64,
    iterations: usize,
}

/// Outcome of one trial step.
struct Trial {
    theta: Vec<f64>,
    cost: f64,
    /// Fall of the cost as a fraction of it: real and predicted.
    fall: f64,
    expected: f64,
    /// Slope of the cost along the step, as a fraction of it.
    slope: f64,
    /// Scaled length of the step.
    length: f64,
    /// The whole step of the linear model fitted into the region.
    newton: bool,
}

impl<'a, P: Residuals> Search<'a, P> {
    fn new(problem: &'a P, start: &[f64], bounds: &'a Bounds) -> Self {
        let theta: Vec<f64> = (0..start.len()).map(|j| bounds.clamp(j, start[j])).collect();
        let here = reduce(problem, &theta);
        let scale = vec![0.0; theta.len()];
        let mut search = Self { problem, bounds, theta, here, is_reduced: true, scale, radius: 0.0, iterations: 0 };
        search.rescale();
        search
    }

    /// Computes the slopes where the last step led.
    fn reduce(&mut self) {
        if !self.is_reduced {
            self.here = reduce(self.problem, &self.theta);
            self.is_reduced = true;
            self.rescale();
        }
    }

    fn run(&mut self, options: &Options) -> StopReason {
        if !self.is_finite() {
            return StopReason::NotFinite;
        }
        self.radius = options.radius * Some(self.scaled_norm(&self.theta)).filter(|n| *n > 0.0).unwrap_or(1.0);
        while self.iterations < options.iterations {
            self.iterations += 1;
            if self.here.cost == 0.0 {
                return StopReason::ExactFit;
            }
            self.reduce();
            let free = self.free();
            if self.steepest_cosine(&free) <= options.gradient {
                return StopReason::GradientConverged;
            }
            if let Some(reason) = self.descend(&free, options) {
                return reason;
            }
        }
        StopReason::IterationLimit
    }

    /// Shortens the step until one lowers the cost; a reason where the search is over.
    fn descend(&mut self, free: &[usize], options: &Options) -> Option<StopReason> {
        let linear = Linear::new(&self.here, &self.scale, free);
        loop {
            let trial = self.try_step(&linear, free);
            self.adapt_radius(&trial);
            let accepted = trial.fall > 1e-4 * trial.expected && trial.fall > 0.0;
            let reason = self.verdict(&trial, options);
            if accepted {
                (self.theta, self.here.cost, self.is_reduced) = (trial.theta, trial.cost, false);
            }
            if accepted || reason.is_some() {
                return reason;
            }
        }
    }

    fn try_step(&self, linear: &Linear, free: &[usize]) -> Trial {
        let (step, newton) = linear.step(self.radius);
        let mut theta = self.theta.clone();
        for (&j, p) in free.iter().zip(&step) {
            theta[j] = self.bounds.clamp(j, theta[j] + p);
        }
        let moved = DVector::from_iterator(theta.len(), theta.iter().zip(&self.theta).map(|(new, old)| new - old));
        let image = &self.here.triangle * &moved;
        let slope = image.dot(&self.here.right) / self.here.cost;
        let cost = cost(self.problem, &theta);
        let fall = 1.0 - cost / self.here.cost;
        Trial {
            theta,
            cost,
            fall: if fall.is_finite() { fall } else { f64::NEG_INFINITY },
            expected: -(2.0 * slope + image.norm_squared() / self.here.cost),
            slope,
            length: self.scaled_norm(moved.as_slice()),
            newton,
        }
    }

    /// Moré's rules: shrink after a poor prediction, grow after a good one.
    fn adapt_radius(&mut self, trial: &Trial) {
        if self.iterations == 1 {
            self.radius = self.radius.min(trial.length);
        }
        // A step that the bounds cut may point uphill in the linear model: then only a shorter one helps.
        let ratio = if trial.expected > 0.0 { trial.fall / trial.expected } else { -1.0 };
        if ratio.is_nan() || ratio <= 0.25 {
            let shrink = if trial.fall >= 0.0 {
                0.5
            } else {
                (0.5 * trial.slope / (trial.slope + 0.5 * trial.fall)).clamp(0.1, 0.5)
            };
            let shrink = if shrink.is_finite() { shrink } else { 0.1 };
            self.radius = shrink * self.radius.min(trial.length / 0.1);
        } else if trial.newton || ratio >= 0.75 {
            self.radius = trial.length / 0.5;
        }
    }

    fn verdict(&self, trial: &Trial, options: &Options) -> Option<StopReason> {
        if trial.cost == 0.0 {
            return Some(StopReason::ExactFit);
        }
        let small = |fraction: f64| fraction.abs() <= options.cost.max(f64::EPSILON);
        if small(trial.fall) && small(trial.expected) && trial.fall <= 2.0 * trial.expected.abs().max(f64::EPSILON) {
            return Some(StopReason::CostConverged);
        }
        let reach = options.step.max(f64::EPSILON) * self.scaled_norm(&self.theta);
        (self.radius <= reach).then_some(StopReason::StepConverged)
    }

    /// Parameters that may move.
    fn free(&self) -> Vec<usize> {
        let gradient = self.gradient();
        (0..self.theta.len()).filter(|&j| !self.bounds.holds(j, self.theta[j], gradient[j])).collect()
    }

    fn gradient(&self) -> DVector<f64> {
        self.here.triangle.tr_mul(&self.here.right)
    }

    fn steepest_cosine(&self, free: &[usize]) -> f64 {
        let gradient = self.gradient();
        let norm = self.here.cost.sqrt();
        let cosine = |&j: &usize| {
            let column = self.here.triangle.column(j).norm();
            if column > 0.0 { gradient[j].abs() / (column * norm) } else { 0.0 }
        };
        free.iter().map(cosine).fold(0.0, f64::max)
    }

    fn rescale(&mut self) {
        for (j, scale) in self.scale.iter_mut().enumerate() {
            *scale = scale.max(self.here.triangle.column(j).norm());
        }
    }

    /// ‖D p‖; a parameter without any influence so far counts with weight one.
    fn scaled_norm(&self, p: &[f64]) -> f64 {
        let squares = p.iter().zip(&self.scale).map(|(p, d)| (p * weight(*d)).powi(2));
        squares.sum::<f64>().sqrt()
    }

    fn is_finite(&self) -> bool {
        self.here.cost.is_finite() && self.here.triangle.iter().all(|v| v.is_finite())
    }

    fn covariance(&mut self) -> DMatrix<f64> {
        self.reduce();
        let n = self.theta.len();
        let mut covariance = DMatrix::from_element(n, n, f64::NAN);
        let freedom = self.problem.rows() as f64 - n as f64;
        if freedom <= 0.0 || !self.is_finite() {
            return covariance;
        }
        let inside = |j: &usize| self.theta[*j] > self.bounds.lower[*j] && self.theta[*j] < self.bounds.upper[*j];
        let free: Vec<usize> = (0..n).filter(inside).collect();
        if free.is_empty() {
            return covariance;
        }
        let norms: Vec<f64> = (0..n).map(|j| self.here.triangle.column(j).norm()).collect();
        let inverse = Linear::new(&self.here, &norms, &free).inverse_normal();
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                covariance[(i, j)] = inverse[(a, b)] * self.here.cost / freedom;
            }
        }
        covariance
    }
}
