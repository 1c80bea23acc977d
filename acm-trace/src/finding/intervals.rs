//! Errors with their 95 % intervals: bootstrap over blocks. Efron & Tibshirani (1993), An Introduction to the Bootstrap, ch. 13.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finding::Estimate;

/// Draws of the bootstrap.
const DRAWS: usize = 1000;

/// Sum of squares and samples of one block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Sum over samples and outputs.
    pub squares: f64,
    /// Number of samples.
    pub samples: usize,
}

/// Returns the root mean square over blocks, with its interval.
pub fn bootstrap(parts: &[Part], seed: u64) -> Estimate {
    let value = root(parts.iter());
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let drawn: Vec<&Part> = (0..parts.len()).map(|_| &parts[random.random_range(0..parts.len())]).collect();
            root(drawn.into_iter())
        })
        .collect();
    draws.sort_by(f64::total_cmp);
    let at = |share: f64| draws[((DRAWS - 1) as f64 * share).round() as usize];
    Estimate { value, interval: if parts.is_empty() { [value; 2] } else { [at(0.025), at(0.975)] } }
}

/// Returns the mean over blocks of the change in mean square, with its interval; of no change where there is no block.
pub fn bootstrap_change(before: &[Part], after: &[Part], seed: u64) -> Estimate {
    let changes: Vec<f64> = before
        .iter()
        .zip(after)
        .map(|(before, after)| (after.squares - before.squares) / before.samples.max(1) as f64)
        .collect();
    if changes.is_empty() {
        return Estimate { value: 0.0, interval: [0.0; 2] };
    }
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / changes.len() as f64;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| mean(&mut (0..changes.len()).map(|_| changes[random.random_range(0..changes.len())])))
        .collect();
    draws.sort_by(f64::total_cmp);
    let at = |share: f64| draws[((DRAWS - 1) as f64 * share).round() as usize];
    Estimate { value: mean(&mut changes.iter().copied()), interval: [at(0.025), at(0.975)] }
}

fn root<'p>(parts: impl Iterator<Item = &'p Part>) -> f64 {
    let (squares, samples) = parts.fold((0.0, 0), |(s, n), part| (s + part.squares, n + part.samples));
    if samples > 0 { (squares / samples as f64).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: blocks that are all alike leave no doubt; two kinds of block bracket the mean.
    #[test]
    fn the_bootstrap_brackets() {
        let same = vec![Part { squares: 40.0, samples: 10 }; 8];
        assert_eq!(bootstrap(&same, 1), Estimate { value: 2.0, interval: [2.0, 2.0] });
        let mixed: Vec<Part> =
            (0..20).map(|k| Part { squares: if k % 2 == 0 { 10.0 } else { 90.0 }, samples: 10 }).collect();
        let estimate = bootstrap(&mixed, 1);
        assert!((estimate.value - 5f64.sqrt()).abs() < 1e-12);
        assert!(estimate.interval[0] > 1.5 && estimate.interval[0] < 2.1 && estimate.interval[1] < 2.8);
    }
}
