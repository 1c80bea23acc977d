//! The strain model as a least squares problem over some of its parameters.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::least_squares::Residuals;
use crate::levenberg_marquardt::Bounds;
use crate::observations::Observations;
use crate::tip_model::StrainModel;

/// Residual = predicted − measured, m, with the parameters in `free` moving and all others as in `model`.
pub(crate) struct StrainFit<'a> {
    model: &'a StrainModel,
    free: Vec<usize>,
    /// Row by row, so that a sample lies together.
    actuators: DMatrix<f64>,
    measured: DMatrix<f64>,
}

/// Largest |a|: beyond it the constant part of the curvature is a rounding error of the rest.
const LARGEST_STRAIN_PARAMETER: f64 = 20.0;

/// Largest tilt and twist of the base, rad.
const LARGEST_TURN: f64 = std::f64::consts::PI;

impl<'a> StrainFit<'a> {
    pub fn new(model: &'a StrainModel, free: Vec<usize>, data: &Observations) -> Self {
        Self { model, free, actuators: data.actuators.transpose(), measured: data.measured.transpose() }
    }

    /// Values of the free parameters.
    pub fn start(&self) -> Vec<f64> {
        self.free.iter().map(|&j| self.model.parameters()[j]).collect()
    }

    /// All parameters, with the free ones from `theta`.
    pub fn all(&self, theta: &[f64]) -> Vec<f64> {
        let mut all = self.model.parameters().to_vec();
        for (&j, value) in self.free.iter().zip(theta) {
            all[j] = *value;
        }
        all
    }

    /// Bounds of the free parameters.
    pub fn bounds(&self) -> Bounds {
        let limit = |&j: &usize| {
            let turns = self.model.registration_range().start..self.model.registration_range().start + 3;
            if self.model.strain_range().contains(&j) {
                LARGEST_STRAIN_PARAMETER
            } else if turns.contains(&j) {
                LARGEST_TURN
            } else {
                f64::INFINITY
            }
        };
        let upper: Vec<f64> = self.free.iter().map(limit).collect();
        Bounds { lower: upper.iter().map(|limit| -limit).collect(), upper }
    }

    fn subtract_measured(&self, sample: usize, out: &mut [f64]) {
        for (out, measured) in out.iter_mut().zip(self.measured.column(sample).iter()) {
            *out -= measured;
        }
    }

    fn actuators(&self, sample: usize) -> &[f64] {
        let width = self.actuators.nrows();
        &self.actuators.as_slice()[sample * width..(sample + 1) * width]
    }
}

impl Residuals for StrainFit<'_> {
    fn parameters(&self) -> usize {
        self.free.len()
    }

    fn samples(&self) -> usize {
        self.measured.ncols()
    }

    fn outputs(&self) -> usize {
        self.measured.nrows()
    }

    fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]) {
        let (theta, mut scratch) = (self.all(theta), self.model.scratch());
        for (out, sample) in out.chunks_exact_mut(self.outputs()).zip(range) {
            self.model.predict_with(&theta, self.actuators(sample), &mut scratch, out);
            self.subtract_measured(sample, out);
        }
    }

    fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        let (theta, mut scratch) = (self.all(theta), self.model.scratch());
        let outputs = self.outputs();
        let mut rows = vec![0.0; outputs * theta.len()];
        for (k, (out, sample)) in out.chunks_exact_mut(outputs).zip(range).enumerate() {
            let q = self.actuators(sample);
            self.model.jacobian_with(&theta, q, &mut scratch, out, &mut rows);
            self.subtract_measured(sample, out);
            for (column, &j) in self.free.iter().enumerate() {
                for o in 0..outputs {
                    slopes[(k * outputs + o, column)] = rows[o * theta.len() + j];
                }
            }
        }
    }
}
