//! Simulation of the trials, and their sampling.
//!
//! Time advances on a uniform grid that starts with the unrecorded pre-roll; samples are read between its points.

use super::arm::Arm;
use super::measurement::{capture, encoders, log};
use super::random::Seeds;
use super::schedule::{Kind, TrialPlan, schedule};
use super::settings::TwinSettings;
use super::validate::BadSetting;
use crate::twin::mechanics::equilibrium::NotBalanced;
use crate::twin::surroundings::flight::Flight;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::{Add, Mul};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A trial of the synthetic campaign, in SI units; every vector has one entry per sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntheticTrial {
    /// Number of the trial, 1–21.
    pub number: usize,
    /// Kind of trial.
    pub kind: Kind,
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// Encoder readings of the first servo, rad.
    pub q1: Vec<f64>,
    /// Encoder readings of the second servo, rad.
    pub q2: Vec<f64>,
    /// Altitude of the arm's attachment, m.
    pub altitude: Vec<f64>,
    /// Throttle, 1.
    pub throttle: Vec<f64>,
    /// Tip relative to the attachment, world axes (z up), m.
    pub tip: Vec<Vector3<f64>>,
    /// Largest joint moment left unbalanced at any step, N·m.
    pub residual: f64,
}

/// All trials of one campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntheticCampaign {
    /// Seed it was made from.
    pub seed: u64,
    /// Trials in the order of their numbers.
    pub trials: Vec<SyntheticTrial>,
}

/// Reasons why no campaign can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TwinError {
    /// A setting has no meaning.
    #[error(transparent)]
    Setting(#[from] BadSetting),
    /// The simulator found no equilibrium at a step.
    #[error("trial {trial}, {time:.2} s: {source}; take a smaller solver.step (it is {step} s) or milder settings")]
    Unbalanced {
        /// Number of the trial.
        trial: usize,
        /// Time in the trial, s.
        time: f64,
        /// Time step, s.
        step: f64,
        /// Remaining residual of Newton's method.
        source: NotBalanced,
    },
}

/// Makes the campaign of 21 trials; `progress` is called with (trials done, trials in all).
///
/// # Errors
/// A setting has no meaning, or a trial has no equilibrium at some step.
pub fn generate(
    settings: &TwinSettings,
    seed: u64,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<SyntheticCampaign, TwinError> {
    settings.validate()?;
    let seeds = Seeds::both(seed);
    let trials = run_all(settings, &schedule(settings, &seeds), &seeds, progress)?;
    Ok(SyntheticCampaign { seed, trials })
}

/// Runs trials in parallel; neither order nor bits depend on the number of threads.
///
/// # Errors
/// As [`run_trial`], of any of them.
pub fn run_all(
    settings: &TwinSettings,
    plans: &[TrialPlan],
    seeds: &Seeds,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<SyntheticTrial>, TwinError> {
    let done = AtomicUsize::new(0);
    let run = |plan: &TrialPlan| {
        let trial = run_trial(settings, plan, seeds);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, plans.len());
        trial
    };
    plans.par_iter().map(run).collect()
}

/// Runs one trial.
///
/// # Errors
/// There is no equilibrium at some step.
pub fn run_trial(settings: &TwinSettings, plan: &TrialPlan, seeds: &Seeds) -> Result<SyntheticTrial, TwinError> {
    let step = settings.solver.step;
    let start = -settings.measurement.preroll;
    let steps = ((plan.end() - start) / step).ceil() as usize + 2;
    let flight = Flight::new(settings, plan, seeds, steps);
    let unbalanced = |time| move |source| TwinError::Unbalanced { trial: plan.number, time, step, source };
    let mut arm = Arm::new(settings, plan, seeds, steps).map_err(unbalanced(start))?;
    let mut tips = Vec::with_capacity(steps);
    for n in 0..steps {
        let time = start + step * n as f64;
        tips.push(arm.advance(plan.actuators(time), &flight, n).map_err(unbalanced(time))?);
    }
    let places: Vec<f64> = plan.times.iter().map(|time| (time - start) / step).collect();
    let at = |course: &[f64]| places.iter().map(|place| between_steps(course, *place)).collect();
    let [altitude, throttle] = log(settings, plan, seeds, &flight, &at);
    let readings = encoders(&settings.measurement, plan, seeds);
    let sampled: Vec<_> = places.iter().map(|place| between_steps(&tips, *place)).collect();
    Ok(SyntheticTrial {
        number: plan.number,
        kind: plan.kind,
        time: plan.times.clone(),
        q1: readings.iter().map(|reading| reading[0]).collect(),
        q2: readings.iter().map(|reading| reading[1]).collect(),
        altitude,
        throttle,
        tip: capture(settings, plan, seeds, &sampled),
        residual: arm.largest_residual(),
    })
}

/// Returns the value between grid points, linear.
fn between_steps<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(values: &[T], place: f64) -> T {
    let left = place as usize;
    let share = place - left as f64;
    values[left] * (1.0 - share) + values[left + 1] * share
}
