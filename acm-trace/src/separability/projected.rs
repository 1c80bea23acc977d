//! Least squares of one effect that imitates another, with recalibration projected out.
//!
//! ```text
//! min over θ of min over δ of ‖d_a − d(θ) − J δ‖² + prior
//! ```
//!
//! Fits are those of [`acm_core::levenberg_marquardt`]. Golub & Pereyra (2003), Inverse Problems 19(2).

use std::ops::Range;

use acm_core::effects::instance::Instance;
use acm_core::least_squares::Residuals;
use acm_core::levenberg_marquardt::{Bounds, Options, fit};
use nalgebra::{DMatrix, DVector};

use super::displacement::{displacement, free, with_slopes};
use super::recalibration::Recalibration;
use super::start::forget_start;
use super::trials::Trials;

/// Stopping criteria of a fit: the share needs an accuracy of about a hundredth.
const ENDS: Options = Options { iterations: 5, cost: 1e-3, step: 1e-2, gradient: 1e-2, radius: 10.0 };

/// Imitation as a least-squares problem: one sample with all NM + P residuals.
pub struct Projected<'p> {
    /// Trials.
    pub trials: &'p Trials<'p>,
    /// The imitating effect.
    pub instance: &'p Instance,
    /// Displacement d_a.
    pub original: &'p DVector<f64>,
    /// Recalibration.
    pub by: &'p Recalibration,
    /// Parameters θ where a fit begins.
    pub start: &'p [f64],
}

impl Projected<'_> {
    /// Returns the sum of squares that is left, prior included, and without it.
    pub fn fitted(&self) -> (f64, f64) {
        let (specs, free) = (self.instance.parameters(), free(self.instance));
        let bounds = Bounds {
            lower: free.iter().map(|&j| specs[j].lower).collect(),
            upper: free.iter().map(|&j| specs[j].upper).collect(),
        };
        let start: Vec<f64> = free.iter().map(|&j| self.start[j]).collect();
        let ended = fit(self, &start, &bounds, &ENDS);
        let left = self.left(&ended.theta, false);
        (ended.cost, left.rows(0, self.trials.rows()).norm_squared())
    }

    /// Returns the remaining residual, with its slopes if `sloped`.
    fn left(&self, values: &[f64], sloped: bool) -> DMatrix<f64> {
        let mut theta = self.start.to_vec();
        free(self.instance).iter().zip(values).for_each(|(&j, value)| theta[j] = *value);
        let mut columns = match sloped {
            true => with_slopes(self.trials, self.instance, &theta),
            false => {
                let d = displacement(self.trials, self.instance, &theta);
                DMatrix::from_column_slice(d.len(), 1, d.as_slice())
            }
        };
        columns.neg_mut();
        let mut first = columns.column_mut(0);
        first += self.original;
        forget_start(self.trials, self.instance, &theta, &mut columns);
        self.by.without(self.trials, &columns)
    }
}

impl Residuals for Projected<'_> {
    fn parameters(&self) -> usize {
        free(self.instance).len()
    }

    fn samples(&self) -> usize {
        1
    }

    fn outputs(&self) -> usize {
        self.trials.rows() + self.trials.calibrated()
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
