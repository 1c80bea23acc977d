//! Errors on untouched trials: the last thing that is computed, and what nothing is chosen by.

use acm_core::effects::instance::Instance;
use acm_core::response::Response;
use nalgebra::{DMatrix, DVector};

use crate::evaluate::{self, Point, Tip};
use crate::intervals::Part;
use crate::prepared::Prepared;
use crate::series::Series;
use crate::setup::{Setup, ranges};

/// Parts of an untouched trial that the bootstrap draws from.
const PARTS: usize = 12;

/// A model, ready to predict.
#[derive(Debug, Clone)]
pub struct Model {
    /// With its calibration and map.
    pub response: Response,
    /// In the order of action.
    pub instances: Vec<Instance>,
    /// θ of each.
    pub theta: Vec<Vec<f64>>,
    /// Variance of the noise in one weighted output.
    pub noise: f64,
}

/// Untouched trials at the full rate of the record, as far as `samples` allows; blocks are parts of trials.
pub fn untouched(prepared: &Prepared, samples: usize) -> Vec<Series> {
    let trials = &prepared.case.untouched;
    let total: usize = trials.iter().map(|trial| trial.record.samples()).sum();
    let stride = total.div_ceil(samples.max(1)).max(1);
    let mut series: Vec<Series> = trials.iter().map(|trial| Series::new(trial, stride)).collect();
    for (s, series) in series.iter_mut().enumerate() {
        let count = series.samples();
        series.block = (0..count).map(|k| PARTS * s + PARTS * k / count).collect();
    }
    series
}

/// measured − predicted of every trial [N×M], SI, whether it counts or not; the warm-up tells the state at the start.
pub fn residuals(prepared: &Prepared, series: &[Series], model: &Model) -> Vec<Vec<f64>> {
    let free = model.response.parameters().len();
    let prior = (DMatrix::zeros(free, free), DVector::zeros(free));
    let (instances, theta) = (&model.instances, &model.theta);
    let (rig, response, weight) = (&prepared.case.rig, model.response.clone(), prepared.weight.clone());
    let setup = Setup::new(rig, series, response, instances, theta, weight, model.noise, prior);
    let delta = DVector::zeros(free);
    let point = Point { instances, theta, delta: &delta };
    (0..series.len())
        .map(|s| {
            let residual = evaluate::residual_everywhere(&setup, s, point, Tip::Exact);
            residual.iter().zip(setup.weight.iter().cycle()).map(|(r, weight)| r / weight).collect()
        })
        .collect()
}

/// Sums of squares of the reported outputs, block by block.
pub fn parts(prepared: &Prepared, series: &[Series], residuals: &[Vec<f64>]) -> Vec<Part> {
    let (width, reported) = (prepared.weight.len(), prepared.case.reported.clone());
    let of = |(series, residual): (&Series, &Vec<f64>)| {
        ranges(series)
            .into_iter()
            .map(|(_, rows)| {
                let counted: Vec<usize> = rows.filter(|&k| series.counts[k]).collect();
                let square = |k: usize| -> f64 {
                    reported.clone().map(|o| (prepared.weight[o] * residual[k * width + o]).powi(2)).sum()
                };
                Part { squares: counted.iter().map(|&k| square(k)).sum(), samples: counted.len() }
            })
            .filter(|part| part.samples > 0)
            .collect::<Vec<Part>>()
    };
    series.iter().zip(residuals).flat_map(of).collect()
}
