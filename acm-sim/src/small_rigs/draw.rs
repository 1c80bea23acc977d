//! Random numbers of one rig: one stream for each purpose, selected by kind and seed.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::StandardNormal;

/// A stream of random numbers.
pub struct Draw(ChaCha8Rng);

impl Draw {
    /// Returns the stream of a kind, a seed and a purpose.
    pub fn new(kind: u64, seed: u64, purpose: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        // Beyond the streams of the arm's trials.
        generator.set_stream((1 << 48) + (kind << 32) + purpose);
        Self(generator)
    }

    /// Draws a number between two limits, each equally likely.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Draws a number between two positive limits, each order of magnitude equally likely.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Draws a standard normal number.
    pub fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// Draws whether an event of this probability happens.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.0.random::<f64>() < probability
    }

    /// Draws one of the first `many` numbers.
    pub fn index(&mut self, many: usize) -> usize {
        self.0.random_range(0..many)
    }

    /// Draws −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.happens(0.5) { 1.0 } else { -1.0 }
    }

    /// Draws `count` different ones of the first `many` numbers, in increasing order.
    pub fn subset(&mut self, many: usize, count: usize) -> Vec<usize> {
        let mut all: Vec<usize> = (0..many).collect();
        for k in 0..count.min(many) {
            let other = k + self.index(many - k);
            all.swap(k, other);
        }
        all.truncate(count);
        all.sort_unstable();
        all
    }
}
