//! Everything that the fits of one round share: trials, the model around which they move, and how far it may be recalibrated.
//!
//! ```text
//! y ≈ O( F( p(Q(q); θ_ref) + ∂p/∂θ δ + Σ_f w_f u_f + offset ) ),   cost = Σ ‖r‖²/σ² + (δ − δ_0)ᵀ Λ (δ − δ_0)
//! ```
//!
//! | symbol | meaning                                                        | shape | unit |
//! | `δ`    | change of the calibrated parameters                            | P     | SI   |
//! | `δ_0`  | the calibration itself, seen from θ_ref                        | P     | SI   |
//! | `Λ`    | precision of the calibration; zero where it may move freely    | P × P |      |
//! | `σ²`   | variance of the noise in one weighted output                   |       |      |
//! | `r`    | weight × (measured − predicted); zero where a sample does not count | N × M | |

use std::ops::Range;

use acm_core::augmented;
use acm_core::effects::instance::Instance;
use acm_core::response::{Linearised, Response};
use acm_core::rig::Rig;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::series::Series;
use crate::tall::product;

/// The model at the place around which a round moves, for one trial.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Actuators as the effects of the reference left them, all T samples.
    pub q: Vec<Vec<f64>>,
    /// Outputs and slopes at the N samples.
    pub linear: Linearised,
    /// Displacement per unit of load at the N samples; empty without a strain model.
    pub fields: Vec<f64>,
    /// −weight × ∂y/∂δ, NM × P: slopes of the residual, zero where a sample does not count.
    pub by_parameter: DMatrix<f64>,
    /// JᵀJ of it for each block range.
    pub normal: Vec<DMatrix<f64>>,
    /// The same of the whole trial.
    pub whole: DMatrix<f64>,
}

/// See the head of this file.
#[derive(Debug, Clone)]
pub struct Setup<'a> {
    /// Signals.
    pub rig: &'a Rig,
    /// Trials.
    pub series: &'a [Series],
    /// Around which everything moves.
    pub response: Response,
    /// One for each trial.
    pub references: Vec<Reference>,
    /// Of each output.
    pub weight: Vec<f64>,
    /// σ².
    pub noise: f64,
    /// Λ.
    pub precision: DMatrix<f64>,
    /// δ_0.
    pub centre: DVector<f64>,
}

impl<'a> Setup<'a> {
    /// Linearises `response` with the actuation effects of `instances` around every sample of `series`.
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        rig: &'a Rig,
        series: &'a [Series],
        response: Response,
        instances: &[Instance],
        theta: &[Vec<f64>],
        weight: Vec<f64>,
        noise: f64,
        prior: (DMatrix<f64>, DVector<f64>),
    ) -> Self {
        let theta: Vec<&[f64]> = theta.iter().map(Vec::as_slice).collect();
        let references =
            series.par_iter().map(|series| Reference::new(series, &response, instances, &theta, &weight)).collect();
        Self { rig, series, response, references, weight, noise, precision: prior.0, centre: prior.1 }
    }

    /// Number of outputs M.
    pub fn outputs(&self) -> usize {
        self.weight.len()
    }

    /// Number of calibrated parameters P.
    pub fn calibrated(&self) -> usize {
        self.centre.len()
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.series.iter().flat_map(|series| &series.block).max().map_or(0, |last| last + 1)
    }
}

impl Reference {
    fn new(series: &Series, response: &Response, instances: &[Instance], theta: &[&[f64]], weight: &[f64]) -> Self {
        let q = augmented::actuation(instances, theta, &series.record);
        let linear = response.linearised_at(&q, &series.rows);
        let fields = response.fields_at(&q, &series.rows);
        let width = weight.len();
        let free = linear.by_parameter.len() / (series.samples() * width).max(1);
        let by_parameter = DMatrix::from_fn(series.samples() * width, free, |row, j| {
            if series.counts[row / width] { -weight[row % width] * linear.by_parameter[row * free + j] } else { 0.0 }
        });
        let rows = |samples: Range<usize>| samples.start * width..samples.end * width;
        let normal = ranges(series)
            .into_iter()
            .map(|(_, samples)| product(&by_parameter, &by_parameter, rows(samples)))
            .collect();
        let whole = product(&by_parameter, &by_parameter, 0..by_parameter.nrows());
        Self { q, linear, fields, by_parameter, normal, whole }
    }
}

/// Blocks of a trial, each with its range of samples.
pub fn ranges(series: &Series) -> Vec<(usize, Range<usize>)> {
    let mut ranges: Vec<(usize, Range<usize>)> = Vec::new();
    for (k, &block) in series.block.iter().enumerate() {
        match ranges.last_mut() {
            Some((last, range)) if *last == block => range.end = k + 1,
            _ => ranges.push((block, k..k + 1)),
        }
    }
    ranges
}
