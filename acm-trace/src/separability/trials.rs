//! Trials with the nominal model linearised in its actuators and its calibrated parameters.
//!
//! ```text
//! y(q̃, δ) = y + ∂y/∂q (q̃ − q) + ∂y/∂δ δ
//! ```
//!
//! | symbol | meaning                                                              | shape     |
//! | `q, q̃` | actuators as recorded, and after an effect                           | A columns |
//! | `y`    | prediction of the model at the N compared samples                    | N × M     |
//! | `δ`    | change of the calibrated parameters                                  | P         |
//! | `w`    | weight of an output; zero where a sample does not count              | NM        |
//! | `J`    | w ∂y/∂δ                                                              | NM × P    |
//!
//! Rows are samples, then outputs; trials are stacked.

use std::ops::Range;

use acm_core::response::{Linearised, Response};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::prepared::Prepared;
use crate::series::Series;
use crate::tall::product;

/// Trials with the linearised nominal model; see the head of this file.
#[derive(Debug, Clone)]
pub struct Trials<'a> {
    /// Signals, and the weight of each output.
    pub prepared: &'a Prepared,
    /// Trials one by one.
    pub all: Vec<Trial<'a>>,
    /// Weights w.
    pub weight: Vec<f64>,
    /// Slopes J.
    pub by_parameter: DMatrix<f64>,
    /// Products JᵀJ.
    pub normal: DMatrix<f64>,
    /// Variance σ²: mean square of the calibrated model's residual in one weighted output, here or in the trials that
    /// calibrated it.
    pub noise: f64,
}

/// One trial.
#[derive(Debug, Clone)]
pub struct Trial<'a> {
    /// Signals of the trial.
    pub series: &'a Series,
    /// Rows of the trial among those of all trials.
    pub rows: Range<usize>,
    /// Outputs y, with the addends of every prediction, and ∂y/∂q.
    pub linear: Linearised,
    /// Displacement per unit of load at the N samples; empty without a strain model.
    pub fields: Vec<f64>,
}

impl<'a> Trials<'a> {
    /// Linearises the calibrated model around every sample of `series`.
    pub fn new(prepared: &'a Prepared, series: &'a [Series]) -> Self {
        let mut all: Vec<Trial> = series.par_iter().map(|series| Trial::new(series, &prepared.response)).collect();
        let (width, mut first) = (prepared.weight.len(), 0);
        for trial in &mut all {
            trial.rows = first..first + trial.series.samples() * width;
            first = trial.rows.end;
        }
        let counts = all.iter().flat_map(|trial| &trial.series.counts);
        let weight: Vec<f64> = counts
            .flat_map(|counts| prepared.weight.iter().map(move |weight| if *counts { *weight } else { 0.0 }))
            .collect();
        let mut by_parameter = DMatrix::zeros(first, prepared.response.parameters().len());
        for trial in &mut all {
            trial.move_slopes(&weight, &mut by_parameter);
        }
        let normal = product(&by_parameter, &by_parameter, 0..first);
        let mut trials = Self { prepared, all, weight, by_parameter, normal, noise: 0.0 };
        trials.noise = trials.left().norm_squared() / (trials.counted() * width).max(1) as f64;
        trials
    }

    /// Returns the number of rows NM.
    pub fn rows(&self) -> usize {
        self.by_parameter.nrows()
    }

    /// Returns the number of calibrated parameters P.
    pub fn calibrated(&self) -> usize {
        self.by_parameter.ncols()
    }

    /// Returns the number of samples that count.
    pub fn counted(&self) -> usize {
        self.all.iter().map(|trial| trial.series.counts.iter().filter(|counts| **counts).count()).sum()
    }

    /// Writes w (y − other) of one trial into its rows of a column.
    pub fn weigh(&self, trial: &Trial, y: &[f64], other: &[f64], column: &mut [f64]) {
        let rows = column[trial.rows.clone()].iter_mut().zip(&self.weight[trial.rows.clone()]);
        rows.zip(y.iter().zip(other)).for_each(|((into, weight), (y, other))| *into = weight * (y - other));
    }

    /// Returns the weighted measured − predicted, trial by trial.
    pub fn left(&self) -> DVector<f64> {
        let mut left = DVector::zeros(self.rows());
        for trial in &self.all {
            self.weigh(trial, &trial.series.measured, &trial.linear.outputs, left.as_mut_slice());
        }
        left
    }
}

impl<'a> Trial<'a> {
    fn new(series: &'a Series, response: &Response) -> Self {
        let q = &series.record.actuators;
        let mut linear = response.linearised_at(q, &series.rows);
        linear.outputs.iter_mut().zip(&series.offset).for_each(|(y, offset)| *y += offset);
        Self { series, rows: 0..0, linear, fields: response.fields_at(q, &series.rows) }
    }

    /// Writes ∂y/∂δ into J.
    fn move_slopes(&mut self, weight: &[f64], into: &mut DMatrix<f64>) {
        let (slopes, free) = (std::mem::take(&mut self.linear.by_parameter), into.ncols());
        for (row, k) in self.rows.clone().enumerate() {
            (0..free).for_each(|j| into[(k, j)] = weight[k] * slopes[row * free + j]);
        }
    }
}
