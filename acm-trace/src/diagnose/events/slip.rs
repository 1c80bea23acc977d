//! A slip of one actuator: a constant offset of that actuator from an instant on.
//!
//! ```text
//! r(t) ≈ b · ∂y/∂q_i(t)  for t ≥ t₀,    a · ∂y/∂q_i(t)  before,    slip = b − a
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | `b` | offset after the slip | of the actuator |
//! | `a` | offset before: 0; free with a single trial, where calibration splits the slip | of the actuator |
//!
//! Running sums give every t₀ of every trial and actuator in one pass. A slip is sudden: the offsets in short windows before and after it
//! must differ as a and b do, and by more than those of neighbouring windows elsewhere. This excludes drifts and random walks. Offsets in
//! all windows must also scatter little about a and b, which excludes slow noise.

use acm_core::display::shown;
use rayon::prelude::*;

use crate::diagnose::events::signature::Signature;
use crate::diagnose::remainder::{Remainder, TrialRemainder};
use crate::diagnose::samples::counted;

/// Window on either side, as a share of the trial's samples; it has at least [`LEAST_WINDOW`] of them.
const WINDOW: f64 = 0.05;
const LEAST_WINDOW: usize = 8;

/// The step in the windows, as a share of the step between the levels.
const SUDDEN: std::ops::Range<f64> = 0.5..1.7;

/// Squared threshold, as a multiple of the difference of neighbouring windows elsewhere.
const BEYOND_NEIGHBOURS: f64 = 8.0;

/// Smallest ratio of a slip's reduction to a window's scatter, or to the noise of one sample: above the best t₀ by chance.
const BEYOND_CHANCE: f64 = 25.0;

/// Smallest ratio of a slip's reduction to that of an offset of the whole trial.
const BEYOND_OFFSET: f64 = 1.25;

struct Found {
    trial: usize,
    actuator: usize,
    /// Time since the trial began, s.
    time: f64,
    step: f64,
    taken: f64,
}

/// Returns the slip with the largest reduction; none if none is sudden.
pub(crate) fn slip(remainder: &Remainder) -> Option<Signature> {
    let actuators = remainder.rig.actuators.len();
    let tasks: Vec<(usize, usize)> =
        (0..remainder.trials.len()).flat_map(|trial| (0..actuators).map(move |a| (trial, a))).collect();
    let found: Vec<Option<Found>> = tasks.par_iter().map(|&(trial, a)| slip_of(remainder, trial, a)).collect();
    let best = found.into_iter().flatten().max_by(|a, b| a.taken.total_cmp(&b.taken))?;
    let actuator = &remainder.rig.actuators[best.actuator];
    let (size, name) = (shown(best.step, &actuator.unit), remainder.trials[best.trial].name);
    Some(Signature {
        kind: "slip",
        taken: best.taken,
        what: format!("{} slips by {size} at {:.1} s of trial {name}", actuator.name, best.time),
    })
}

fn slip_of(remainder: &Remainder, index: usize, actuator: usize) -> Option<Found> {
    let (trial, outputs) = (&remainder.trials[index], remainder.outputs());
    let rows = counted(trial, outputs);
    let window = ((WINDOW * rows.len() as f64) as usize).max(LEAST_WINDOW);
    if rows.len() < 2 * window + 1 {
        return None;
    }
    let sums = Sums::new(remainder, trial, &rows, actuator);
    let alone = remainder.trials.len() == 1;
    let taken = |k: usize| {
        let before = if alone { sums.taken(0, k) } else { 0.0 };
        before + sums.taken(k, rows.len())
    };
    let (at, most) = (window..=rows.len() - window).map(|k| (k, taken(k))).max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let before = if alone { sums.level(0, at) } else { 0.0 };
    let step = sums.level(at, rows.len()) - before;
    let here = sums.level(at, at + window) - sums.level(at - window, at);
    let sudden = SUDDEN.contains(&(here / step)) && here * here > BEYOND_NEIGHBOURS * sums.wander(window, at);
    let offset = sums.taken(0, rows.len()).max(taken_by_mean(trial, &rows, outputs));
    let chance = sums.scatter(window, at, before, before + step).max(remainder.floor.powi(2));
    let clear = most > BEYOND_CHANCE * chance && most > BEYOND_OFFSET * offset;
    let time = trial.record.time[rows[at]] - trial.record.time[0];
    (clear && sudden).then_some(Found { trial: index, actuator, time, step, taken: most })
}

/// Returns the reduction of the sum of squares by the mean of the trial.
fn taken_by_mean(trial: &TrialRemainder, rows: &[usize], outputs: usize) -> f64 {
    let sum = |m: usize| rows.iter().map(|&t| trial.residual[t * outputs + m]).sum::<f64>();
    (0..outputs).map(|m| sum(m).powi(2) / rows.len() as f64).sum()
}

/// Running sums of z·r and z·z with z = ∂y/∂q_i, from the first row to each.
struct Sums {
    joint: Vec<f64>,
    own: Vec<f64>,
}

impl Sums {
    fn new(remainder: &Remainder, trial: &TrialRemainder, rows: &[usize], actuator: usize) -> Self {
        let (outputs, actuators) = (remainder.outputs(), remainder.rig.actuators.len());
        let (mut joint, mut own) = (vec![0.0], vec![0.0]);
        let (mut sum, mut square) = (0.0, 0.0);
        for &t in rows {
            for k in t * outputs..(t + 1) * outputs {
                let slope = trial.slopes[k * actuators + actuator];
                if slope.is_finite() {
                    sum += slope * trial.residual[k];
                    square += slope * slope;
                }
            }
            joint.push(sum);
            own.push(square);
        }
        Self { joint, own }
    }

    /// Returns the offset of the actuator in rows `from..to`.
    fn level(&self, from: usize, to: usize) -> f64 {
        let own = self.own[to] - self.own[from];
        if own > 0.0 { (self.joint[to] - self.joint[from]) / own } else { 0.0 }
    }

    /// Returns the first rows of consecutive windows that do not hold row `at`.
    fn windows(&self, window: usize, at: usize) -> Vec<usize> {
        let whole = (0..self.own.len() / window).map(|k| k * window).filter(|from| from + window < self.own.len());
        whole.filter(|from| *from >= at || from + window <= at).collect()
    }

    /// Returns the mean reduction by offsets of single windows, relative to `before` row `at` and `after`.
    fn scatter(&self, window: usize, at: usize, before: f64, after: f64) -> f64 {
        let windows = self.windows(window, at);
        let of = |&from: &usize| {
            let apart = self.level(from, from + window) - if from < at { before } else { after };
            (self.own[from + window] - self.own[from]) * apart * apart
        };
        windows.iter().map(of).sum::<f64>() / windows.len().saturating_sub(2).max(1) as f64
    }

    /// Returns the mean square of the difference between neighbouring windows, on either side of row `at`.
    fn wander(&self, window: usize, at: usize) -> f64 {
        let windows = self.windows(window, at);
        let same_side =
            windows.windows(2).filter(|pair| pair[1] == pair[0] + window && (pair[0] < at) == (pair[1] < at));
        let of = |pair: &[usize]| self.level(pair[1], pair[1] + window) - self.level(pair[0], pair[0] + window);
        let squares: Vec<f64> = same_side.map(|pair| of(pair).powi(2)).collect();
        squares.iter().sum::<f64>() / squares.len().max(1) as f64
    }

    /// Returns the reduction of the sum of squares by an offset of rows `from..to`.
    fn taken(&self, from: usize, to: usize) -> f64 {
        self.level(from, to) * (self.joint[to] - self.joint[from])
    }
}
