//! Leaky units with fixed random weights: the equation of [`super`], one trial at a time.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::diagnose::random::{normal, permutation};

/// Sum of the absolute values of a row of W.
const RADIUS: f64 = 0.5;

/// Number of units that a unit reads. Like the number of signals, it is small, so that some states are functions of one
/// signal alone.
const HEARD: usize = 2;
const SEEN: usize = 1;

/// Standard deviation of the weights of signals, and of b: small, so that states are smooth functions of the past.
const SIGNAL: f64 = 0.25;
const BIAS: f64 = 0.1;

/// Number of steps after which the state at the start has settled: its remainder falls with the powers of [`RADIUS`].
const SETTLING: usize = 40;

/// Number of the random stream of the weights.
const STREAM: u64 = 2;

/// Units with their weights.
pub(super) struct Network {
    units: Vec<Unit>,
}

struct Unit {
    /// Entries of a row of W, by the unit that is read.
    heard: Vec<(usize, f64)>,
    /// Entries of a row of V, by the signal.
    signals: Vec<(usize, f64)>,
    bias: f64,
    /// Time constant τ, s.
    time_constant: f64,
}

impl Network {
    /// Returns a unit for each time constant, s.
    pub fn new(signals: usize, time_constants: &[f64], seed: u64) -> Self {
        let units = time_constants.len();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(STREAM);
        let unit = |&time_constant: &f64| Unit {
            heard: row_of_radius(sparse(&mut random, units, HEARD)),
            signals: sparse(&mut random, signals, SEEN).into_iter().map(|(s, weight)| (s, SIGNAL * weight)).collect(),
            bias: BIAS * normal(&mut random),
            time_constant,
        };
        Self { units: time_constants.iter().map(unit).collect() }
    }

    /// Returns h at each time stamp of one trial, [T×n] row by row.
    pub fn states(&self, time: &[f64], inputs: &[Vec<f64>]) -> Vec<f64> {
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

    /// Returns the steady state for a constant input equal to the first sample.
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

/// Draws `some` of `count` indices with weights of variance 1; all where there are no more.
fn sparse(random: &mut ChaCha8Rng, count: usize, some: usize) -> Vec<(usize, f64)> {
    permutation(random, count).into_iter().take(some).map(|place| (place, normal(random))).collect()
}

/// Scales a row so that its absolute values add up to [`RADIUS`].
fn row_of_radius(mut row: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    let sum: f64 = row.iter().map(|(_, weight)| weight.abs()).sum();
    if sum > 0.0 {
        row.iter_mut().for_each(|(_, weight)| *weight *= RADIUS / sum);
    }
    row
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    fn network(units: usize) -> Network {
        Network::new(2, &(0..units).map(|i| 0.05 * 1.2f64.powi(i as i32)).collect::<Vec<f64>>(), 3)
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

    /// Oracle: a unit without recurrent input is a filter of first order: after a step of its input at time 0 what is left of the old
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
