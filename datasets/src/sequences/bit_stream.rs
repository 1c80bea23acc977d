//! Parity of a stream of bits that is observed through its events: a task that needs elapsed times.
//!
//! ```text
//! bits    b_0 … b_{L−1}, each 0 or 1 with probability ½,   L uniform on 2 … N − 1
//! events  p_0 = 0; every p with b_p ≠ b_{p−1}; L − 1 if it is none of these
//! input   b_p        elapsed  (p_k − p_{k−1}) δ,  p_{−1} = −1        label  (Σ b) mod 2, after the last event
//! ```
//!
//! | symbol | meaning                                                        |
//! | ------ | -------------------------------------------------------------- |
//! | `N`    | the length that sequences were padded to; no stream reaches it |
//! | `L`    | bits of a stream                                               |
//! | `δ`    | time from bit to bit; 1/N in the source                        |
//!
//! But for a last event that repeats its bit, the events alternate: how many ones there were is in the elapsed times alone.
//! [`limit`] says how often the label can be guessed without them.
//!
//! The rule, with N = 32, 100,000 training and 10,000 test streams, is that of Lechner and Hasani (2020), "Learning
//! long-term dependencies in irregularly-sampled time series", class `XORData` of mlech26l/ode-lstms, which the paper of
//! the closed-form network (Hasani et al. 2022, Nature Machine Intelligence 4) uses too. The random generator is another,
//! so the streams are others of the same distribution. Batches do the padding.

pub mod limit;

use nalgebra::DMatrix;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};

use super::{Asked, Sequence, SequenceSet};

/// Which streams are made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BitStream {
    /// Streams to learn from; the last of them choose the epoch.
    pub training: usize,
    /// Share of them that chooses the epoch.
    pub validation: f64,
    /// Streams that are looked at once.
    pub test: usize,
    /// N.
    pub length: usize,
    /// δ, s.
    pub step: f64,
    /// Decides every bit.
    pub seed: u64,
}

impl Default for BitStream {
    fn default() -> Self {
        Self { training: 100_000, validation: 0.05, test: 10_000, length: 32, step: 0.03125, seed: 1 }
    }
}

/// The streams as sequences of events.
///
/// # Panics
/// If `length` is less than 3, or `validation` not a share.
pub fn generate(asked: &BitStream) -> SequenceSet {
    let mut training = part(asked, "training", asked.training, 0);
    let chosen_by = (asked.validation * asked.training as f64).round() as usize;
    let validation = training.split_off(asked.training - chosen_by);
    SequenceSet {
        channels: vec!["bit".into()],
        outputs: vec!["odd".into()],
        asked: Asked::Last,
        training,
        validation,
        test: part(asked, "test", asked.test, 1),
    }
}

/// Streams from one stream of random numbers.
fn part(asked: &BitStream, name: &str, count: usize, number: u64) -> Vec<Sequence> {
    let mut generator = ChaCha8Rng::seed_from_u64(asked.seed);
    generator.set_stream(number);
    let draw = |i: usize| {
        let length = generator.random_range(2..asked.length);
        let bits: Vec<bool> = (0..length).map(|_| generator.random()).collect();
        sequence(format!("{name}{i}"), &bits, asked.step)
    };
    (0..count).map(draw).collect()
}

/// The events of one stream.
fn sequence(name: String, bits: &[bool], step: f64) -> Sequence {
    let last = bits.len() - 1;
    let places: Vec<usize> = (0..=last).filter(|&p| p == 0 || p == last || bits[p] != bits[p - 1]).collect();
    let before = std::iter::once(0).chain(places.iter().map(|p| p + 1));
    let elapsed = places.iter().zip(before).map(|(p, before)| (p + 1 - before) as f64 * step).collect();
    let ones = bits.iter().filter(|bit| **bit).count();
    Sequence {
        name,
        elapsed,
        inputs: DMatrix::from_iterator(places.len(), 1, places.iter().map(|&p| f64::from(u8::from(bits[p])))),
        targets: DMatrix::from_element(1, 1, (ones % 2) as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn events(bits: &str) -> (Vec<f64>, Vec<f64>, f64) {
        let bits: Vec<bool> = bits.chars().map(|bit| bit == '1').collect();
        let made = sequence(String::new(), &bits, 1.0);
        (made.inputs.iter().copied().collect(), made.elapsed, made.targets[(0, 0)])
    }

    /// Oracle: by hand.
    #[test]
    fn runs_become_events() {
        assert_eq!(events("11"), (vec![1.0, 1.0], vec![1.0, 1.0], 0.0));
        assert_eq!(events("01"), (vec![0.0, 1.0], vec![1.0, 1.0], 1.0));
        assert_eq!(events("1110"), (vec![1.0, 0.0], vec![1.0, 3.0], 1.0));
        assert_eq!(events("0011101111"), (vec![0.0, 1.0, 0.0, 1.0, 1.0], vec![1.0, 2.0, 3.0, 1.0, 3.0], 1.0));
    }

    /// Oracle: the events alone give the stream back, and so its parity; and the moments of the distribution: 16.5 bits
    /// on average, half of them ones, half of the labels odd, 9.25 events (1 + (L − 1)/2 + ½).
    #[test]
    fn events_tell_the_whole_stream() {
        let set = generate(&BitStream { training: 20_000, test: 100, ..BitStream::default() });
        assert_eq!((set.training.len(), set.validation.len(), set.test.len()), (19_000, 1_000, 100));
        let (mut bits, mut ones, mut odd, mut events) = (0.0, 0.0, 0.0, 0.0);
        for sequence in set.training.iter().chain(&set.validation) {
            let mut own = sequence.inputs[(0, 0)];
            let counts: Vec<f64> = sequence.elapsed.iter().map(|share| share * 32.0).collect();
            for k in 1..counts.len() {
                own += sequence.inputs[(k - 1, 0)] * (counts[k] - 1.0) + sequence.inputs[(k, 0)];
            }
            assert_eq!(own % 2.0, sequence.targets[(0, 0)], "{sequence:?}");
            let length: f64 = counts.iter().sum();
            assert!((2.0..=31.0).contains(&length));
            bits += length;
            ones += own;
            odd += sequence.targets[(0, 0)];
            events += counts.len() as f64;
        }
        let n = 20_000.0;
        assert!((bits / n - 16.5).abs() < 0.2, "{}", bits / n);
        assert!((ones / bits - 0.5).abs() < 0.005, "{}", ones / bits);
        assert!((odd / n - 0.5).abs() < 0.015, "{}", odd / n);
        assert!((events / n - 9.25).abs() < 0.1, "{}", events / n);
    }

    #[test]
    fn a_seed_decides_all_and_parts_differ() {
        let small = BitStream { training: 200, test: 200, ..BitStream::default() };
        let set = generate(&small);
        assert_eq!(set.hash(), generate(&small).hash());
        assert_ne!(set.hash(), generate(&BitStream { seed: 2, ..small.clone() }).hash());
        let same = set.test.iter().zip(&set.training).filter(|(a, b)| a.elapsed == b.elapsed).count();
        assert!(same < 20, "{same} of 200 test streams are training streams");
        let longer = generate(&BitStream { training: 300, validation: 0.0, ..small });
        assert_eq!(set.training[..], longer.training[..set.training.len()], "more streams leave the first ones alone");
    }
}
