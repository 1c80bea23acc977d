//! Random draws from one explicit stream.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Draws from the standard normal distribution. Box & Muller (1958), Ann. Math. Stat. 29(2).
pub(crate) fn normal(random: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.random_range(0.0..1.0f64)).ln()).sqrt();
    radius * random.random_range(0.0..std::f64::consts::TAU).cos()
}

/// Returns the numbers below `count` in random order.
pub(crate) fn permutation(random: &mut ChaCha8Rng, count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for k in (1..count).rev() {
        order.swap(k, random.random_range(0..=k));
    }
    order
}
