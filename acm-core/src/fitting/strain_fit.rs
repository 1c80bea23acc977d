//! The strain model as a least squares problem over some of its parameters.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::fitting::least_squares::Residuals;
use crate::fitting::levenberg_marquardt::Bounds;
use crate::fitting::observations::Observations;
use crate::tip_model::{Block, STRIDE, StrainModel};

/// Residual = w (predicted − measured), m, with the parameters in `free` moving and all others as in `model`. The weights w are 1 but for
/// [`StrainFit::weighted`].
///
/// Rows go by block, output, sample.
pub(crate) struct StrainFit<'a> {
    model: &'a StrainModel,
    free: Vec<usize>,
    /// Column by column, so that samples lie side by side.
    actuators: &'a DMatrix<f64>,
    measured: &'a DMatrix<f64>,
    /// Weight of each sample; none where all are 1.
    weights: Option<&'a [f64]>,
}

/// Largest |a|: beyond it the constant part of the curvature is a rounding error of the rest.
const LARGEST_STRAIN_PARAMETER: f64 = 20.0;

/// Largest tilt and twist of the base, rad.
const LARGEST_TURN: f64 = std::f64::consts::PI;

impl<'a> StrainFit<'a> {
    pub fn new(model: &'a StrainModel, free: Vec<usize>, data: &'a Observations) -> Self {
        Self { model, free, actuators: &data.actuators, measured: &data.measured, weights: None }
    }

    /// Lets each sample count by its weight.
    pub fn weighted(self, weights: &'a [f64]) -> Self {
        Self { weights: Some(weights), ..self }
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

    /// Fills `block` with the samples from `first` on, at all parameters.
    fn fill(&self, theta: &[f64], first: usize, samples: usize, block: &mut Block) {
        for a in 0..self.actuators.ncols() {
            let column = &self.actuators.as_slice()[a * self.samples() + first..][..samples];
            block.actuator_mut(a)[..samples].copy_from_slice(column);
        }
        self.model.fill(theta, samples, block);
    }

    /// Residuals of one block.
    fn subtract(&self, first: usize, samples: usize, block: &Block, out: &mut [f64]) {
        for (o, out) in out.chunks_exact_mut(samples).enumerate() {
            let measured = &self.measured.as_slice()[o * self.samples() + first..];
            let both = block.output(o).iter().zip(measured);
            out.iter_mut().zip(both).for_each(|(out, (predicted, measured))| *out = predicted - measured);
            self.weigh(first, out);
        }
    }

    /// Multiplies the values of the samples from `first` on by their weights.
    fn weigh(&self, first: usize, values: &mut [f64]) {
        if let Some(weights) = self.weights {
            values.iter_mut().zip(&weights[first..]).for_each(|(value, weight)| *value *= weight);
        }
    }
}

/// Samples of a range, block by block: the first one and their number.
fn blocks(range: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    let end = range.end;
    range.step_by(STRIDE).map(move |first| (first, STRIDE.min(end - first)))
}

impl Residuals for StrainFit<'_> {
    fn parameters(&self) -> usize {
        self.free.len()
    }

    fn samples(&self) -> usize {
        self.measured.nrows()
    }

    fn outputs(&self) -> usize {
        self.measured.ncols()
    }

    fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]) {
        let (theta, mut block) = (self.all(theta), self.model.block());
        for ((first, samples), out) in blocks(range).zip(out.chunks_mut(STRIDE * self.outputs())) {
            self.fill(&theta, first, samples, &mut block);
            self.subtract(first, samples, &block, out);
        }
    }

    fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        let (theta, mut block) = (self.all(theta), self.model.block_with_slopes(&self.free));
        let height = slopes.nrows();
        let mut row = 0;
        for ((first, samples), out) in blocks(range).zip(out.chunks_mut(STRIDE * self.outputs())) {
            self.fill(&theta, first, samples, &mut block);
            self.subtract(first, samples, &block, out);
            for (j, column) in slopes.as_mut_slice().chunks_exact_mut(height).enumerate() {
                for (o, column) in column[row..row + out.len()].chunks_exact_mut(samples).enumerate() {
                    column.copy_from_slice(&block.by_parameter(o, j)[..samples]);
                    self.weigh(first, column);
                }
            }
            row += out.len();
        }
    }
}
