//! Oracle: the true structure, fitted to the development trials as recorded.
//!
//! ```text
//! θ̂ = argmin Σ_dev (y − f(u; θ))² from the true θ on,     error = RMSE of f(u; θ̂) on the held-out trials
//! ```
//!
//! Inputs are the recorded ones, straight between samples; where rates are needed, the half-width of their parabolas is
//! chosen in development as well. A cause is *separable* where the structure without it, refitted, is worse on pieces
//! of the held-out trials by more than two standard errors of the paired difference, and by more than 5 % of the noise.

use super::drive::Drive;
use super::fit::{Variable, fit, standard_errors};
use super::recorded::{Recorded, SimTrial};
use crate::role::Role;
use crate::small_rigs::plants::plant::{Free, Plant};

/// Result of the oracle fit of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Oracle {
    /// RMSE on the held-out trials, noise included, in the output's unit.
    pub error: f64,
    /// RMSE in development.
    pub development: f64,
    /// Standard deviation of the noise.
    pub noise: f64,
    /// Fitted values, in the order of the plant's.
    pub values: Vec<f64>,
    /// Standard errors of the values to first order, for white noise of the output alone; see [`super::deviations`] for
    /// all of it.
    pub standard_errors: Vec<f64>,
    /// Half-width of the parabolas that rates come from, s; none where no rate is needed.
    pub smoothing: Option<f64>,
    /// Predicted output of each held-out trial.
    pub prediction: Vec<Vec<f64>>,
    /// Whether each cause can be distinguished from its absence.
    pub separable: Vec<bool>,
    /// Standard errors by which the absence of each cause worsens the held-out trials.
    pub missed: Vec<f64>,
}

/// Half-widths of parabolas that are tried, in sampling periods.
const WIDTHS: [f64; 6] = [1.0, 2.0, 4.0, 7.0, 12.0, 20.0];
/// Number of pieces of held-out trials that are compared.
const PIECES: usize = 16;
/// Standard errors, and share of the noise, by which an absent cause has to be missed.
const SURE: f64 = 2.0;
const SHOWS: f64 = 0.05;

/// Fits the true structure, and tests for each cause whether its absence worsens the error.
pub fn oracle(recorded: &Recorded) -> Oracle {
    let plant = &recorded.truth.plant;
    let (smoothing, parts, values) = widths(recorded)
        .into_iter()
        .map(|width| {
            let parts = Parts::new(recorded, width);
            let values = parts.fitted(plant, None);
            (width, parts, values)
        })
        .min_by(|(_, a, x), (_, b, y)| a.error(plant, x).total_cmp(&b.error(plant, y)))
        .unwrap_or_else(|| (None, Parts::new(recorded, None), plant.values()));
    let noise = recorded.truth.noise[0];
    let prediction: Vec<Vec<f64>> = parts.held.iter().map(|(drive, _)| plant.respond(&values, drive)).collect();
    let left = parts.left(plant, &values);
    let absent = |cause: usize| parts.left(plant, &parts.fitted(plant, Some(cause)));
    let absences: Vec<(bool, f64)> =
        (0..recorded.truth.causes.len()).map(|cause| misses(&left, &absent(cause), noise)).collect();
    Oracle {
        error: rms(&left),
        development: parts.error(plant, &values),
        noise,
        separable: absences.iter().map(|(shows, _)| *shows).collect(),
        missed: absences.iter().map(|(_, errors)| *errors).collect(),
        standard_errors: parts.standard_errors(plant, &values, noise),
        values,
        smoothing,
        prediction,
    }
}

/// Returns the values of the true structure, fitted to a recording with this half-width of its parabolas, s.
pub(super) fn fitted(recorded: &Recorded, smoothing: Option<f64>) -> Vec<f64> {
    Parts::new(recorded, smoothing).fitted(&recorded.truth.plant, None)
}

/// Returns the half-widths to be tried, s; one without where no rate is needed.
fn widths(recorded: &Recorded) -> Vec<Option<f64>> {
    let Some(_) = recorded.truth.plant.joint() else { return vec![None] };
    let time = &recorded.trials[0].time;
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    WIDTHS.map(|width| Some(width * step)).into()
}

/// Development and held-out trials as drives, with what was measured.
struct Parts {
    development: Vec<(Drive, Vec<f64>)>,
    held: Vec<(Drive, Vec<f64>)>,
}

impl Parts {
    fn new(recorded: &Recorded, width: Option<f64>) -> Self {
        let joint = recorded.truth.plant.joint();
        let one = |trial: &SimTrial| (drive(trial, joint, width), trial.outputs[0].clone());
        let of = |role: Role| recorded.trials(role).map(one).collect();
        Self { development: of(Role::Development), held: of(Role::HeldOut) }
    }

    /// Returns the values fitted in development, without a cause where one is named.
    fn fitted(&self, plant: &Plant, without: Option<usize>) -> Vec<f64> {
        let absent = |k: usize| without.is_some() && plant.free[k].cause == without;
        let start: Vec<f64> =
            plant.free.iter().enumerate().map(|(k, free)| if absent(k) { free.neutral } else { free.value }).collect();
        let variables = variables(plant, absent);
        fit(&|values| residuals(plant, values, &self.development), &start, &variables)
    }

    fn standard_errors(&self, plant: &Plant, values: &[f64], noise: f64) -> Vec<f64> {
        let variables = variables(plant, |_| false);
        standard_errors(&|values| residuals(plant, values, &self.development), values, &variables, noise)
    }

    fn error(&self, plant: &Plant, values: &[f64]) -> f64 {
        rms(&residuals(plant, values, &self.development))
    }

    fn left(&self, plant: &Plant, values: &[f64]) -> Vec<f64> {
        residuals(plant, values, &self.held)
    }
}

fn variables(plant: &Plant, held: impl Fn(usize) -> bool) -> Vec<Variable> {
    let one = |(k, free): (usize, &Free)| Variable { scale: free.scale, lower: free.lower, held: held(k) };
    plant.free.iter().enumerate().map(one).collect()
}

/// Returns a trial as recorded.
fn drive(trial: &SimTrial, joint: Option<usize>, width: Option<f64>) -> Drive {
    let drive = Drive {
        time: trial.time.clone(),
        actuators: trial.actuators.clone(),
        contexts: trial.contexts.clone(),
        asked: trial.time.clone(),
        motion: [const { vec![] }; 3],
    };
    match (joint, width) {
        (Some(joint), Some(width)) => drive.with_motion(joint, width),
        _ => drive,
    }
}

fn residuals(plant: &Plant, values: &[f64], parts: &[(Drive, Vec<f64>)]) -> Vec<f64> {
    let one = |(drive, measured): &(Drive, Vec<f64>)| {
        let predicted = plant.respond(values, drive);
        // What is no number is as wrong as can be, and never chosen.
        predicted.iter().zip(measured).map(|(a, b)| if a.is_finite() { a - b } else { 1e150 }).collect::<Vec<f64>>()
    };
    parts.iter().flat_map(one).collect()
}

/// Returns whether residuals without a cause are significantly worse, and by enough to show; and by how many standard
/// errors.
fn misses(with: &[f64], without: &[f64], noise: f64) -> (bool, f64) {
    let size = with.len().div_ceil(PIECES).max(1);
    let squares = |left: &[f64]| -> Vec<f64> { left.chunks(size).map(|piece| rms(piece).powi(2)).collect() };
    let worse: Vec<f64> = squares(without).iter().zip(squares(with)).map(|(a, b)| a - b).collect();
    let many = worse.len() as f64;
    let mean = worse.iter().sum::<f64>() / many;
    let spread = (worse.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (many - 1.0).max(1.0)).sqrt();
    let errors = mean / (spread / many.sqrt()).max(f64::MIN_POSITIVE);
    (errors > SURE && rms(without) - rms(with) > SHOWS * noise, errors)
}

/// Returns the root mean square.
fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand-made residuals; one that grows everywhere, one that grows in one piece alone, one by too little.
    #[test]
    fn what_is_missed_is_missed_everywhere_and_shows() {
        let with = vec![1.0; 160];
        let everywhere: Vec<f64> = (0..160).map(|k| 1.2 + 0.01 * f64::from(k % 3)).collect();
        let once: Vec<f64> = (0..160).map(|k| if k < 10 { 9.0 } else { 1.0 }).collect();
        let little = vec![1.03; 160];
        assert!(misses(&with, &everywhere, 1.0).0);
        let of_one = misses(&with, &once, 1.0);
        assert!(!of_one.0 && (of_one.1 - 1.0).abs() < 1e-9, "mean and standard error are the same number");
        assert!(!misses(&with, &little, 1.0).0);
    }
}
