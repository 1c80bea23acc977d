//! Is anything left that a small recurrent network on the recorded signals predicts, on blocks that took no part?
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

use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::diagnose::random::{normal, permutation};
use crate::diagnose::readout::{Columns, readout};
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, median_step, moments};
use crate::finding::Probe;

/// Units n at most.
const MOST_UNITS: usize = 64;

/// Sum of the absolute values of a row of W.
const RADIUS: f64 = 0.5;

/// Units that a unit hears, and signals that it sees: few, so that some states are functions of one signal alone.
const HEARD: usize = 2;
const SEEN: usize = 1;

/// Standard deviation of the weights of signals, and of b: small, so that states are smooth functions of the past.
const SIGNAL: f64 = 0.25;
const BIAS: f64 = 0.1;

/// Longest time constant, as a share of the longest trial.
const LONGEST: f64 = 1.0 / 3.0;

/// Steps after which the state at the start has settled: what is left of it falls with the powers of [`RADIUS`].
const SETTLING: usize = 40;

/// Purpose number of the stream that weights are drawn from.
const STREAM: u64 = 2;

/// Whether a recurrent network predicts from recorded signals what is left; in the sense of [`crate::diagnose::probe::probe`].
pub fn recurrent(remainder: &Remainder, seed: u64) -> Probe {
    readout(remainder, seed, |rows, most| columns(remainder, rows, most, seed))
}

/// z, h and squares of h at `samples`, `most` columns at most.
fn columns(remainder: &Remainder, samples: &[Sample], most: usize, seed: u64) -> Columns {
    let inputs = inputs(remainder);
    let signals = inputs.first().map_or(0, |input| input.len());
    let units = (most.saturating_sub(signals) / 2).min(MOST_UNITS);
    let network = Network::new(units, signals, time_constants(remainder, units), seed);
    let of = |(trial, input): (usize, &Vec<Vec<f64>>)| network.states(&remainder.trials[trial].record.time, input);
    let states: Vec<Vec<f64>> = inputs.par_iter().enumerate().map(of).collect();
    let z = (0..signals).map(|s| samples.iter().map(|k| inputs[k.trial][s][k.t]).collect::<Vec<f64>>());
    let h: Vec<Vec<f64>> =
        (0..units).map(|i| samples.iter().map(|k| states[k.trial][k.t * units + i]).collect()).collect();
    let plain: Vec<Vec<f64>> = z.chain(h.iter().cloned()).filter_map(standardised).collect();
    let squares = h.iter().map(|h| {
        let (mean, _) = moments(h);
        h.iter().map(|h| (h - mean).powi(2)).collect::<Vec<f64>>()
    });
    let squares: Vec<Vec<f64>> = squares.filter_map(standardised).collect();
    let all: Vec<&Vec<f64>> = plain.iter().chain(&squares).take(most).collect();
    let x = DMatrix::from_fn(samples.len(), all.len(), |row, column| all[column][row]);
    Columns { plain: plain.len().min(all.len()), x }
}

/// z of each trial, [S][T]: signals that vary over all trials.
fn inputs(remainder: &Remainder) -> Vec<Vec<Vec<f64>>> {
    let signals = |record: &acm_core::record::Record| -> Vec<Vec<f64>> {
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

/// Mean and standard deviation; none where nothing varies.
fn scale(column: &[f64]) -> Option<(f64, f64)> {
    let (mean, sd) = moments(column);
    let largest = column.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    (sd > 1e-9 * largest).then_some((mean, sd))
}

/// What is not finite becomes the mean.
fn normalised(x: &[f64], (mean, sd): (f64, f64)) -> Vec<f64> {
    x.iter().map(|x| (x - mean) / sd).map(|z| if z.is_finite() { z } else { 0.0 }).collect()
}

fn standardised(column: Vec<f64>) -> Option<Vec<f64>> {
    scale(&column).map(|scale| normalised(&column, scale))
}

/// τ of each unit, s.
fn time_constants(remainder: &Remainder, units: usize) -> Vec<f64> {
    let times = || remainder.trials.iter().map(|trial| trial.record.time.as_slice());
    let durations = times().filter_map(|time| Some(time.last()? - time.first()?));
    let shortest = median_step(times()).max(f64::MIN_POSITIVE);
    let longest = (LONGEST * durations.fold(0.0, f64::max)).max(shortest);
    let share = |i: usize| i as f64 / (units.max(2) - 1) as f64;
    (0..units).map(|i| shortest * (longest / shortest).powf(share(i))).collect()
}

/// See the head of this file.
struct Network {
    units: Vec<Unit>,
}

struct Unit {
    /// Entries of a row of W, by the unit that is heard.
    heard: Vec<(usize, f64)>,
    /// Entries of a row of V, by the signal.
    signals: Vec<(usize, f64)>,
    bias: f64,
    /// τ, s.
    time_constant: f64,
}

impl Network {
    fn new(units: usize, signals: usize, time_constants: Vec<f64>, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(STREAM);
        let unit = |time_constant| Unit {
            heard: row_of_radius(sparse(&mut random, units, HEARD)),
            signals: sparse(&mut random, signals, SEEN).into_iter().map(|(s, weight)| (s, SIGNAL * weight)).collect(),
            bias: BIAS * normal(&mut random),
            time_constant,
        };
        Self { units: time_constants.into_iter().map(unit).collect() }
    }

    /// h at each time stamp of one trial, [T×n] row by row.
    fn states(&self, time: &[f64], inputs: &[Vec<f64>]) -> Vec<f64> {
        let count = self.units.len();
        let mut states = Vec::with_capacity(time.len() * count);
        let mut before = self.settled(inputs);
        for t in 0..time.len() {
            let elapsed = if t > 0 { (time[t] - time[t - 1]).max(0.0) } else { 0.0 };
            let next = self.units.iter().zip(&before).map(|(unit, own)| {
                let kept = (-elapsed / unit.time_constant).exp();
                kept * own + (1.0 - kept) * unit.activation(&before, inputs, t)
            });
            let next: Vec<f64> = next.collect();
            states.extend_from_slice(&next);
            before = next;
        }
        states
    }

    /// The state that the first sample leads to if it stands for ever.
    fn settled(&self, inputs: &[Vec<f64>]) -> Vec<f64> {
        let mut state = vec![0.0; self.units.len()];
        if inputs.iter().any(Vec::is_empty) {
            return state;
        }
        for _ in 0..SETTLING {
            state = self.units.iter().map(|unit| unit.activation(&state, inputs, 0)).collect();
        }
        state
    }
}

impl Unit {
    fn activation(&self, state: &[f64], inputs: &[Vec<f64>], t: usize) -> f64 {
        let heard: f64 = self.heard.iter().map(|&(j, weight)| weight * state[j]).sum();
        let seen: f64 = self.signals.iter().map(|&(s, weight)| weight * inputs[s][t]).sum();
        (heard + seen + self.bias).tanh()
    }
}

/// Some of `count` places with weights of variance 1; all where there are no more.
fn sparse(random: &mut ChaCha8Rng, count: usize, some: usize) -> Vec<(usize, f64)> {
    permutation(random, count).into_iter().take(some).map(|place| (place, normal(random))).collect()
}

/// The same direction with absolute values that add up to [`RADIUS`].
fn row_of_radius(mut row: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    let sum: f64 = row.iter().map(|(_, weight)| weight.abs()).sum();
    if sum > 0.0 {
        row.iter_mut().for_each(|(_, weight)| *weight *= RADIUS / sum);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    fn network(units: usize) -> Network {
        Network::new(units, 2, (0..units).map(|i| 0.05 * 1.2f64.powi(i as i32)).collect(), 3)
    }

    /// Oracle: the largest modulus of the eigenvalues of the dense matrix.
    #[test]
    fn the_spectral_radius_is_below_one() {
        let network = network(40);
        let mut w = DMatrix::zeros(40, 40);
        for (i, unit) in network.units.iter().enumerate() {
            unit.heard.iter().for_each(|&(j, weight)| w[(i, j)] = weight);
        }
        let radius = w.complex_eigenvalues().iter().map(|x| x.norm()).fold(0.0, f64::max);
        assert!(radius > 0.1 && radius <= RADIUS, "{radius}");
        assert_eq!(w.iter().filter(|w| **w != 0.0).count(), 40 * HEARD, "W is sparse");
    }

    /// Oracle: a unit that hears nobody is a filter of first order: after a step of its input at time 0 what is left of the old
    /// value is e^{−t/τ}, wherever the stamps lie.
    #[test]
    fn a_unit_alone_decays_by_its_time_constant() {
        let unit = Unit { heard: vec![], signals: vec![(0, 1.0)], bias: 0.3, time_constant: 0.8 };
        let network = Network { units: vec![unit] };
        let time = [0.0, 0.11, 0.5, 0.52, 1.9];
        let states = network.states(&time, &[vec![-1.0, 0.4, 0.4, 0.4, 0.4]]);
        let (old, new) = ((-0.7f64).tanh(), 0.7f64.tanh());
        for (t, h) in time.iter().zip(&states) {
            let expected = new + (old - new) * (-t / 0.8).exp();
            assert!((h - expected).abs() < 1e-12, "{h} and {expected} at {t} s");
        }
    }

    /// A first sample that stays does not move any state; states stay within −1…1 whatever comes.
    #[test]
    fn a_trial_begins_settled_and_stays_bounded() {
        let (network, time) = (network(30), (0..50).map(|t| 0.1 * f64::from(t)).collect::<Vec<f64>>());
        let still = network.states(&time, &[vec![0.7; 50], vec![-1.2; 50]]);
        for row in still.chunks_exact(30) {
            row.iter().zip(&still[..30]).for_each(|(h, first)| assert!((h - first).abs() < 1e-3));
        }
        let wild: Vec<f64> = (0..50).map(|t| 1e3 * f64::from(t * t).sin()).collect();
        assert!(network.states(&time, &[wild.clone(), wild]).iter().all(|h| h.abs() <= 1.0));
    }
}
