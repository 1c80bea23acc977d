//! Constant offsets of one trial or of each: of the outputs, or of one actuator.
//!
//! ```text
//! r(t) − r₀ ≈ d_k                in trial k,   or   δ_k · ∂y/∂q_i(t)
//! taken     = ‖fit‖² − chance,   chance = Σ_quarters w_q ‖d_q − d‖² / 3
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | `r₀` | median over trials of their means, where there are three or more | of the outputs |
//! | `d`, `δ` | offset of the outputs, of an actuator | of the outputs, of the actuator |
//! | `d_q` | offset in each quarter of the trial, w_q its weight | the same |
//!
//! The spread of the quarters estimates the offset that a slow residual has by chance, which is subtracted.

use acm_core::display::shown;
use nalgebra::DVector;
use rayon::prelude::*;

use crate::diagnose::events::signature::{Signature, chi_square_ratio, unit};
use crate::diagnose::remainder::{Remainder, TrialRemainder};
use crate::diagnose::samples::{counted, median};

/// Number of parts of a trial that are compared with each other.
const PARTS: usize = 4;

/// Fewest samples in a part.
const LEAST_PART: usize = 5;

/// Threshold over chance, in standard deviations.
const BEYOND_CHANCE: f64 = 3.0;

/// Share of the reduction by all offsets above which one trial is named.
const ONE_OF_ALL: f64 = 0.7;

/// A fit of an offset to one trial.
struct Offset {
    trial: usize,
    /// Actuator with the offset; none for the outputs.
    actuator: Option<usize>,
    /// Size of the offset, in the actuator's unit or as ‖d‖.
    size: f64,
    taken: f64,
    chance: f64,
}

impl Offset {
    fn net(&self) -> f64 {
        self.taken - self.chance
    }
}

/// Returns the offset of one trial where it dominates, else those of all; none where trials differ no more than their parts.
pub(crate) fn offsets(remainder: &Remainder) -> Option<Signature> {
    let outputs = remainder.outputs();
    let rows: Vec<Vec<usize>> = remainder.trials.iter().map(|trial| counted(trial, outputs)).collect();
    let long: Vec<usize> = (0..rows.len()).filter(|&k| rows[k].len() >= PARTS * LEAST_PART).collect();
    if long.len() < 2 {
        return None;
    }
    let means: Vec<DVector<f64>> = long.iter().map(|&k| mean(&remainder.trials[k], &rows[k], outputs)).collect();
    let common = common(&means, outputs);
    let of_outputs: Vec<Offset> =
        long.par_iter().map(|&k| outputs_off(&remainder.trials[k], &rows[k], k, &common)).collect();
    one_of(remainder, &rows, &long, &common, &of_outputs).or_else(|| all_of(remainder, &rows, &of_outputs))
}

fn mean(trial: &TrialRemainder, rows: &[usize], outputs: usize) -> DVector<f64> {
    let of = |m: usize| rows.iter().map(|&t| trial.residual[t * outputs + m]).sum::<f64>() / rows.len() as f64;
    DVector::from_fn(outputs, |m, _| of(m))
}

fn common(means: &[DVector<f64>], outputs: usize) -> DVector<f64> {
    let of = |m: usize| {
        let mut values: Vec<f64> = means.iter().map(|mean| mean[m]).collect();
        match values.len() {
            0..=2 => values.iter().sum::<f64>() / values.len().max(1) as f64,
            _ => median(&mut values),
        }
    };
    DVector::from_fn(outputs, |m, _| of(m))
}

fn parts(rows: &[usize]) -> impl Iterator<Item = &[usize]> {
    (0..PARTS).map(|q| &rows[q * rows.len() / PARTS..(q + 1) * rows.len() / PARTS])
}

fn outputs_off(trial: &TrialRemainder, rows: &[usize], index: usize, common: &DVector<f64>) -> Offset {
    let whole = mean(trial, rows, common.len()) - common;
    let apart = |part: &[usize]| (mean(trial, part, common.len()) - common - &whole).norm_squared() * part.len() as f64;
    Offset {
        trial: index,
        actuator: None,
        size: whole.norm(),
        taken: whole.norm_squared() * rows.len() as f64,
        chance: parts(rows).map(apart).sum::<f64>() / (PARTS - 1) as f64,
    }
}

fn actuator_off(
    remainder: &Remainder,
    rows: &[usize],
    index: usize,
    common: &DVector<f64>,
    actuator: usize,
) -> Option<Offset> {
    let (trial, outputs, actuators) = (&remainder.trials[index], common.len(), remainder.rig.actuators.len());
    let sums = |rows: &[usize]| {
        let terms = rows.iter().flat_map(|&t| (0..outputs).map(move |m| (t * outputs + m, m)));
        terms.fold((0.0, 0.0), |(joint, own), (k, m)| {
            let slope = Some(trial.slopes[k * actuators + actuator]).filter(|slope| slope.is_finite()).unwrap_or(0.0);
            (joint + slope * (trial.residual[k] - common[m]), own + slope * slope)
        })
    };
    let (joint, own) = sums(rows);
    let size = joint / own;
    let apart = |part: &[usize]| match sums(part) {
        (joint, own) if own > 0.0 => own * (joint / own - size).powi(2),
        _ => 0.0,
    };
    let chance = parts(rows).map(apart).sum::<f64>() / (PARTS - 1) as f64;
    (own > 0.0).then_some(Offset { trial: index, actuator: Some(actuator), size, taken: joint * size, chance })
}

fn one_of(
    remainder: &Remainder,
    rows: &[Vec<usize>],
    long: &[usize],
    common: &DVector<f64>,
    of_outputs: &[Offset],
) -> Option<Signature> {
    let most = of_outputs.iter().max_by(|a, b| a.taken.total_cmp(&b.taken))?;
    let all: f64 = of_outputs.iter().map(|offset| offset.taken).sum();
    if long.len() < 3 || most.taken < ONE_OF_ALL * all {
        return None;
    }
    let k = most.trial;
    let others = (0..remainder.rig.actuators.len()).filter_map(|a| actuator_off(remainder, &rows[k], k, common, a));
    let actuator = others.max_by(|a, b| a.net().total_cmp(&b.net())).filter(|other| other.net() > most.net());
    let best = actuator.as_ref().unwrap_or(most);
    let noise = remainder.floor.powi(2);
    let clear = best.taken > chi_square_ratio(1.0, BEYOND_CHANCE) * best.chance.max(noise);
    let name = remainder.trials[k].name;
    let what = match best.actuator.map(|a| &remainder.rig.actuators[a]) {
        Some(actuator) => {
            format!("{} is off by {} in trial {name}", actuator.name, shown(best.size, &actuator.unit))
        }
        None => format!("trial {name} is off by {} in the mean", shown(best.size, unit(remainder))),
    };
    clear.then(|| Signature { kind: "offset of one trial", taken: best.net(), what })
}

fn all_of(remainder: &Remainder, rows: &[Vec<usize>], of_outputs: &[Offset]) -> Option<Signature> {
    let taken: f64 = of_outputs.iter().map(|offset| offset.taken).sum();
    let chance: f64 = of_outputs.iter().map(|offset| offset.chance).sum();
    let noise = of_outputs.len() as f64 * remainder.floor.powi(2);
    let clear = taken > chi_square_ratio(of_outputs.len() as f64 - 1.0, BEYOND_CHANCE) * chance.max(noise);
    let samples: usize = of_outputs.iter().map(|offset| rows[offset.trial].len()).sum();
    let size = (taken / samples as f64).sqrt();
    clear.then(|| Signature {
        kind: "offset of each trial",
        taken: taken - chance,
        what: format!("means of trials differ by {} (root mean square)", shown(size, unit(remainder))),
    })
}
