//! Recurrent probe: part of the residual that an echo-state network on the recorded signals predicts on blocks left out.
//!
//! ```text
//! h_i(t_k) = a h_i(t_{k−1}) + (1 − a) tanh(Σ_j W_ij h_j(t_{k−1}) + Σ_s V_is z_s(t_k) + b_i),   a = e^{−(t_k − t_{k−1})/τ_i}
//! ŷ(t_k)   = ȳ + Cᵀ (z, h, (h − h̄)²)(t_k)
//! ```
//!
//! | symbol | meaning | shape |
//! | --- | --- | --- |
//! | `z` | actuators, contexts and acceleration, with mean 0 and variance 1 | S |
//! | `h` | states of the units, in −1…1 | n |
//! | `τ` | time constants, evenly on a logarithmic scale from the sampling step to a third of the longest trial, s | n |
//! | `W, V, b` | fixed random weights; W is sparse | n × n, n × S, n |
//! | `C` | readout by ridge regression ([`crate::diagnose::readout`]) | (S + 2n) × M |
//!
//! The absolute values of each row of W add up to 0.5. So its spectral radius is at most that, and two trajectories under the same
//! signals approach each other whatever their time constants. A trial begins as if its first sample had always been there; nothing
//! passes from one trial to the next. Jaeger (2001), GMD report 148 (echo states); Jaeger et al. (2007), Neural Networks 20(3)
//! (leaky units); Jaeger (2003), NIPS 15 (squares in the readout).

mod network;

use acm_core::record::Record;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::diagnose::readout::{Columns, readout};
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, median_step, moments};
use crate::finding::Probe;
use network::Network;

/// Largest number of units n.
const MOST_UNITS: usize = 64;

/// Longest time constant, as a share of the longest trial.
const LONGEST: f64 = 1.0 / 3.0;

/// Tests whether a recurrent network predicts the residual from recorded signals; the result is that of
/// [`crate::diagnose::probe::probe`].
pub fn recurrent(remainder: &Remainder, seed: u64) -> Probe {
    readout(remainder, seed, |rows, most| columns(remainder, rows, most, seed))
}

/// Returns z, h and squares of h at `samples`, `most` columns at most.
fn columns(remainder: &Remainder, samples: &[Sample], most: usize, seed: u64) -> Columns {
    let inputs = inputs(remainder);
    let signals = inputs.first().map_or(0, Vec::len);
    let units = (most.saturating_sub(signals) / 2).min(MOST_UNITS);
    let network = Network::new(signals, &time_constants(remainder, units), seed);
    let of = |(trial, input): (usize, &Vec<Vec<f64>>)| network.states(&remainder.trials[trial].record.time, input);
    let states: Vec<Vec<f64>> = inputs.par_iter().enumerate().map(of).collect();
    let z = (0..signals).map(|s| samples.iter().map(|k| inputs[k.trial][s][k.t]).collect());
    let h: Vec<Vec<f64>> =
        (0..units).map(|i| samples.iter().map(|k| states[k.trial][k.t * units + i]).collect()).collect();
    let mut columns: Vec<Vec<f64>> = z.chain(h.iter().cloned()).filter_map(standardised).take(most).collect();
    let plain = columns.len();
    columns.extend(h.iter().filter_map(|h| standardised(squares(h))).take(most - plain));
    Columns { x: DMatrix::from_fn(samples.len(), columns.len(), |row, column| columns[column][row]), plain }
}

/// Returns (h − h̄)².
fn squares(h: &[f64]) -> Vec<f64> {
    let (mean, _) = moments(h);
    h.iter().map(|h| (h - mean).powi(2)).collect()
}

/// Returns z of each trial, [S][T]: signals that vary over all trials.
fn inputs(remainder: &Remainder) -> Vec<Vec<Vec<f64>>> {
    let signals = |record: &Record| -> Vec<Vec<f64>> {
        record.actuators.iter().chain(&record.contexts).chain(&record.acceleration).cloned().collect()
    };
    let mut inputs: Vec<Vec<Vec<f64>>> = remainder.trials.iter().map(|trial| signals(trial.record)).collect();
    let count = inputs.iter().map(Vec::len).min().unwrap_or(0);
    let scales: Vec<Option<(f64, f64)>> = (0..count)
        .map(|s| {
            let all: Vec<f64> = inputs.iter().flat_map(|trial| &trial[s]).copied().filter(|x| x.is_finite()).collect();
            scale(&all)
        })
        .collect();
    for trial in &mut inputs {
        let kept = scales.iter().zip(&*trial).filter_map(|(scale, x)| scale.map(|scale| normalised(x, scale)));
        *trial = kept.collect();
    }
    inputs
}

/// Returns the mean and standard deviation; none where nothing varies.
fn scale(column: &[f64]) -> Option<(f64, f64)> {
    let (mean, sd) = moments(column);
    let largest = column.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    (sd > 1e-9 * largest).then_some((mean, sd))
}

/// Standardises values; values that are not finite become the mean.
fn normalised(x: &[f64], (mean, sd): (f64, f64)) -> Vec<f64> {
    x.iter().map(|x| (x - mean) / sd).map(|z| if z.is_finite() { z } else { 0.0 }).collect()
}

fn standardised(column: Vec<f64>) -> Option<Vec<f64>> {
    scale(&column).map(|scale| normalised(&column, scale))
}

/// Returns τ of each unit, s.
fn time_constants(remainder: &Remainder, units: usize) -> Vec<f64> {
    let times = || remainder.trials.iter().map(|trial| trial.record.time.as_slice());
    let durations = times().filter_map(|time| Some(time.last()? - time.first()?));
    let shortest = median_step(times()).max(f64::MIN_POSITIVE);
    let longest = (LONGEST * durations.fold(0.0, f64::max)).max(shortest);
    let share = |i: usize| i as f64 / (units.max(2) - 1) as f64;
    (0..units).map(|i| shortest * (longest / shortest).powf(share(i))).collect()
}
