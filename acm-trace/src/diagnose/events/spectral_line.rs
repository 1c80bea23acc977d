//! A sinusoid of one frequency in all trials, with own amplitudes and phases in each, that no input explains.
//!
//! ```text
//! P(f)  = Σ_trials Σ_m  max over a, b of the reduction of ‖r_m − a cos 2πft − b sin 2πft‖²
//! taken = P(f) − continuum(f)
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | `f` | frequency, from one period in a stretch up to half the rate of sampling | Hz |
//! | `P` | Lomb–Scargle power on time stamps as they are | of the outputs, squared |
//! | `continuum` | P a few lobes beside f; above f corrected for a spectrum that falls with 1/f² | the same |
//!
//! A line stands out of its neighbourhood, and slow noise does not. The search runs over stretches of a few hundred
//! samples, where lobes are wide, and ends with whole trials. Scargle (1982), Astrophys. J. 263.

use acm_core::display::{shown, significant};
use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::diagnose::events::signature::{Signature, chi_square_ratio, unit};
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{counted, median, median_step};

/// Number of samples of a stretch: fewer determine little, more are slow to search.
const STRETCH: std::ops::Range<usize> = 24..512;

/// Samples that are searched in all.
const MOST_SAMPLES: usize = 10_000;

/// Number of frequencies per lobe 1/T.
const PER_LOBE: f64 = 4.0;

/// Largest number of frequencies.
const MOST_FREQUENCIES: usize = 2500;

/// Highest frequency, as a share of half the rate of sampling.
const HIGHEST: f64 = 0.98;

/// Range of the continuum beside the line, in lobes.
const BESIDE: std::ops::Range<f64> = 1.5..6.5;

/// Threshold over chance, in standard deviations: one of thousands of frequencies exceeds 4.
const BEYOND_CHANCE: f64 = 4.0;

/// Share of a signal's variance at the same frequency above which it is mentioned.
const ALSO: f64 = 0.2;

/// One stretch of a trial.
struct Stretch {
    time: Vec<f64>,
    /// Values of each output in a column, without its mean.
    values: Vec<Vec<f64>>,
}

impl Stretch {
    fn new(time: Vec<f64>, mut values: Vec<Vec<f64>>) -> Self {
        for column in &mut values {
            let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
            column.iter_mut().for_each(|r| *r -= mean);
        }
        Self { time, values }
    }

    fn length(&self) -> f64 {
        self.time.last().zip(self.time.first()).map_or(0.0, |(last, first)| last - first)
    }

    /// Returns samples `from..to`.
    fn part(&self, from: usize, to: usize) -> Self {
        Self::new(self.time[from..to].to_vec(), self.values.iter().map(|column| column[from..to].to_vec()).collect())
    }

    /// Returns P at `first`, `first + step`, …. The phase of each sample is advanced by complex multiplication.
    fn powers(&self, first: f64, step: f64, count: usize) -> Vec<f64> {
        let phase = |f: f64| self.time.iter().map(|t| (TAU * f * (t - self.time[0])).sin_cos()).unzip();
        let (mut sine, mut cosine): (Vec<f64>, Vec<f64>) = phase(first);
        let (turn_sine, turn_cosine): (Vec<f64>, Vec<f64>) = phase(step);
        let mut powers = Vec::with_capacity(count);
        for _ in 0..count {
            powers.push(self.power(&sine, &cosine));
            let turns = turn_sine.iter().zip(&turn_cosine);
            for ((s, c), (ds, dc)) in sine.iter_mut().zip(&mut cosine).zip(turns) {
                (*s, *c) = (*s * dc + *c * ds, *c * dc - *s * ds);
            }
        }
        powers
    }

    fn power(&self, sine: &[f64], cosine: &[f64]) -> f64 {
        let (mut ss, mut sc) = (0.0, 0.0);
        for (s, c) in sine.iter().zip(cosine) {
            ss += s * s;
            sc += s * c;
        }
        let cc = sine.len() as f64 - ss;
        let determinant = ss * cc - sc * sc;
        if determinant < 1e-3 * (0.5 * sine.len() as f64).powi(2) {
            return 0.0;
        }
        let reduction = |column: &Vec<f64>| {
            let (mut s_r, mut c_r) = (0.0, 0.0);
            for ((s, c), r) in sine.iter().zip(cosine).zip(column) {
                s_r += s * r;
                c_r += c * r;
            }
            (cc * s_r * s_r - 2.0 * sc * s_r * c_r + ss * c_r * c_r) / determinant
        };
        self.values.iter().map(reduction).sum()
    }
}

/// Returns the most significant line; none where no line is significant.
pub(crate) fn spectral_line(remainder: &Remainder) -> Option<Signature> {
    let trials = trials(remainder);
    let stretches = stretches(&trials);
    let longest = stretches.iter().map(Stretch::length).fold(0.0, f64::max);
    let step = median_step(trials.iter().map(|trial| trial.time.as_slice()));
    if longest <= 0.0 || step <= 0.0 {
        return None;
    }
    let lobe = 1.0 / longest;
    let count = ((HIGHEST * 0.5 / step - lobe) * PER_LOBE / lobe).max(0.0) as usize;
    let powers = spectrum(&stretches, lobe, lobe / PER_LOBE, count.min(MOST_FREQUENCIES));
    let degrees = 2.0 * stretches.len() as f64;
    // The continuum is a median, and the median of few degrees of freedom lies below their mean.
    let rarely = chi_square_ratio(degrees, BEYOND_CHANCE) / chi_square_ratio(degrees, 0.0);
    let lines = (0..powers.len()).filter_map(|k| Some((k, powers[k], continuum(&powers, k)?)));
    let (k, power, continuum) = lines
        .filter(|(_, power, continuum)| *power > rarely * continuum)
        .max_by(|a, b| (a.1 - a.2).total_cmp(&(b.1 - b.2)))?;
    let coarse = lobe * (1.0 + k as f64 / PER_LOBE);
    let found = refined(&trials, coarse, lobe);
    // A stretch has as many free coefficients as a trial, so whole trials hold less of the continuum.
    let below = continuum / power * found.power * (trials.len() as f64 / stretches.len() as f64).min(1.0);
    let taken = found.power - below;
    let samples: usize = trials.iter().map(|trial| trial.time.len()).sum();
    let amplitude = shown((2.0 * taken.max(0.0) / samples as f64).sqrt(), unit(remainder));
    let also = carriers(remainder, found.frequency);
    let note = if also.is_empty() { String::new() } else { format!(", as {} has", also.join(" and ")) };
    let what = format!("a line of {amplitude} at {} Hz{note}", significant(found.frequency, 3));
    Some(Signature { kind: "spectral line", taken, what })
}

fn trials(remainder: &Remainder) -> Vec<Stretch> {
    let outputs = remainder.outputs();
    let of = |trial: &crate::diagnose::remainder::TrialRemainder| {
        let rows = counted(trial, outputs);
        let column = |m: usize| rows.iter().map(|&t| trial.residual[t * outputs + m]).collect();
        Stretch::new(rows.iter().map(|&t| trial.record.time[t]).collect(), (0..outputs).map(column).collect())
    };
    remainder.trials.iter().map(of).filter(|trial| trial.time.len() >= STRETCH.start).collect()
}

/// Cuts the trials into pieces; of very many pieces only some are kept, evenly over all.
fn stretches(trials: &[Stretch]) -> Vec<Stretch> {
    let cuts = trials.iter().flat_map(|trial| {
        let (samples, pieces) = (trial.time.len(), trial.time.len().div_ceil(STRETCH.end));
        (0..pieces).map(move |k| (trial, k * samples / pieces, (k + 1) * samples / pieces))
    });
    let samples: usize = trials.iter().map(|trial| trial.time.len()).sum();
    cuts.step_by(samples.div_ceil(MOST_SAMPLES).max(1)).map(|(trial, from, to)| trial.part(from, to)).collect()
}

fn spectrum(stretches: &[Stretch], first: f64, step: f64, count: usize) -> Vec<f64> {
    let parts: Vec<Vec<f64>> = stretches.par_iter().map(|stretch| stretch.powers(first, step, count)).collect();
    (0..count).map(|k| parts.iter().map(|part| part[k]).sum()).collect()
}

/// Returns the power beside frequency `k` of a spectrum that begins at one lobe; none where there is too little beside
/// it.
fn continuum(powers: &[f64], k: usize) -> Option<f64> {
    let (near, far) = ((BESIDE.start * PER_LOBE) as usize, (BESIDE.end * PER_LOBE) as usize);
    let frequency = |k: usize| k as f64 + PER_LOBE;
    let right = powers.iter().enumerate().take(k + far + 1).skip(k + near);
    let mut right: Vec<f64> = right.map(|(j, power)| power * (frequency(j) / frequency(k)).powi(2)).collect();
    let mut left = powers[(k + 1).saturating_sub(far)..(k + 1).saturating_sub(near)].to_vec();
    let enough = far.saturating_sub(near) / 2;
    match (left.len() >= enough, right.len() >= enough) {
        (true, true) => Some(0.5 * (median(&mut left) + median(&mut right))),
        (true, false) => Some(median(&mut left)),
        (false, true) => Some(median(&mut right)),
        (false, false) => None,
    }
}

struct Line {
    frequency: f64,
    power: f64,
}

/// Returns the line near `coarse` with the largest power over whole trials, refined by a parabola through the highest steps.
fn refined(trials: &[Stretch], coarse: f64, lobe: f64) -> Line {
    let longest = trials.iter().map(Stretch::length).fold(0.0, f64::max);
    let step = (0.1 / longest).min(0.1 * lobe);
    let first = (coarse - 0.75 * lobe).max(0.25 * lobe);
    let powers = spectrum(trials, first, step, (1.5 * lobe / step) as usize + 1);
    let best = powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(k, _)| k);
    let shift = match powers.get(best.saturating_sub(1)..best + 2) {
        Some(&[before, here, after]) if 2.0 * here > before + after => {
            (0.5 * (after - before) / (2.0 * here - before - after)).clamp(-0.5, 0.5)
        }
        _ => 0.0,
    };
    let frequency = first + (best as f64 + shift) * step;
    Line { frequency, power: spectrum(trials, frequency, 0.0, 1)[0] }
}

/// Returns the names of the actuators and contexts that have a good part of their variance at this frequency.
fn carriers(remainder: &Remainder, frequency: f64) -> Vec<String> {
    let share = |column: &(dyn Fn(&acm_core::record::Record) -> Vec<f64> + Sync)| {
        let parts: Vec<(f64, f64)> = remainder
            .trials
            .par_iter()
            .map(|trial| {
                let signal = Stretch::new(trial.record.time.clone(), vec![column(trial.record)]);
                let power = if signal.time.is_empty() { 0.0 } else { signal.powers(frequency, 0.0, 1)[0] };
                (power, signal.values[0].iter().map(|x| x * x).sum::<f64>())
            })
            .collect();
        let (power, all) = parts.iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
        power > ALSO * all && all > 0.0
    };
    let actuators = remainder.rig.actuators.iter().enumerate().filter(|(a, _)| share(&|r| r.actuators[*a].clone()));
    let contexts = remainder.rig.contexts.iter().enumerate().filter(|(e, _)| share(&|r| r.contexts[*e].clone()));
    actuators.chain(contexts).map(|(_, signal)| signal.name.clone()).collect()
}
