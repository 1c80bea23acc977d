//! Errors on untouched trials: the last thing that is computed, and what nothing is chosen by.

use acm_core::effects::instance::Instance;
use acm_core::response::Response;
use nalgebra::{DMatrix, DVector};

use crate::evaluate::{self, Point, Tip};
use crate::figures::figures;
use crate::finding::{Before, Errors, Estimate, Figures, Verdict};
use crate::intervals::{Part, bootstrap};
use crate::moving;
use crate::prepared::Prepared;
use crate::series::Series;
use crate::setup::{Setup, ranges};
use crate::trace::Traced;

/// Samples of untouched trials that are looked at.
const UNTOUCHED_SAMPLES: usize = 30_000;

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

/// Share of the removable error that must be gone from untouched trials for an effect to be called the cause: what only imitates
/// the missing effect fails there.
const GONE: f64 = 0.95;

/// Errors on untouched trials.
pub struct Judged {
    /// The three befores, and after.
    pub errors: Errors,
    /// F: share of the removable error that is gone; none where there was nothing to remove.
    pub removed: Option<f64>,
    /// What is drawn from untouched trials.
    pub figures: Figures,
}

impl Judged {
    /// Predicts the untouched trials with the three befores and the result; errors times `scale`.
    pub fn new(prepared: &Prepared, traced: &Traced, after: &Model, joined: &[Series], seed: u64, scale: f64) -> Self {
        let untouched = untouched(prepared, UNTOUCHED_SAMPLES);
        let bare = |response: Response| Model { response, instances: vec![], theta: vec![], noise: traced.setup.noise };
        let plain = Response::new(prepared.nominal.model.clone(), None, None);
        let start = bare(plain.clone());
        let mapped = bare(plain.with_map(traced.map.clone()));
        let series = if prepared.calibration.is_empty() { &prepared.development } else { joined };
        let again = moving::recalibrated(prepared, series, mapped.response.clone(), traced.setup.noise);
        let models = [&start, &mapped, &bare(again), after];
        let residuals = models.map(|model| residuals(prepared, &untouched, model));
        let parts = residuals.each_ref().map(|residual| parts(prepared, &untouched, residual));
        let [nominal, static_map, recalibrated, with] = parts.each_ref().map(|parts| {
            let estimate = bootstrap(parts, seed);
            Estimate { value: estimate.value * scale, interval: estimate.interval.map(|value| value * scale) }
        });
        let values = [nominal, static_map, recalibrated].map(|estimate| estimate.value);
        let best_of = (0..3).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
        let best = values[best_of];
        let share = prepared.case.reported.len() as f64 / prepared.weight.len() as f64;
        let floor = traced.floor * share.sqrt() * scale;
        let removable = best * best - floor * floor;
        let removed = (removable > 0.09 * floor * floor).then(|| (best * best - with.value * with.value) / removable);
        let before = Before { nominal, static_map, recalibrated };
        let errors = if prepared.is_length() {
            Errors::Length { floor_mm: floor, before_mm: before, after_mm: with }
        } else {
            Errors::Other { unit: prepared.unit(), floor, before, after: with }
        };
        let figures = figures(prepared, &untouched, after, &residuals[0], &residuals[best_of], &residuals[3], scale);
        Self { errors, removed, figures }
    }

    /// The verdict of the development trials, lowered where untouched trials do not bear it out.
    pub fn temper(&self, verdict: Verdict) -> Verdict {
        let matters = self.errors.before().nominal.value > 2.0 * self.errors.floor();
        let gone = self.removed.filter(|_| matters).unwrap_or(1.0);
        match verdict {
            Verdict::Named | Verdict::FormImperfect if gone < GONE => Verdict::Partial,
            verdict => verdict,
        }
    }
}
