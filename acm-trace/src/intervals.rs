//! Intervals that cover: jackknife over blocks for parameters, bootstrap over blocks for errors.
//!
//! ```text
//! s² = (B − 1)/B Σ_b (θ_b − θ̄)²,   θ ± t_{B−1} s
//! ```
//!
//! | symbol | meaning                                            |
//! | `θ_b`  | the value fitted without block b                   |
//! | `B`    | number of blocks                                   |
//! | `t`    | 97.5 % quantile of Student's distribution          |
//!
//! White noise around one optimum would be far too sure: what a model misses repeats itself within a trial. Efron & Tibshirani
//! (1993), An Introduction to the Bootstrap, ch. 11 and 13.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finding::Estimate;

/// Draws of the bootstrap.
const DRAWS: usize = 1000;

/// 95 % interval of a value from its values without each block, and from how far it could be led astray by what the model still
/// misses, which no block left out shows.
pub fn jackknife(value: f64, without: &[f64], slack: f64) -> [f64; 2] {
    let n = without.len() as f64;
    if n < 2.0 {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let mean = without.iter().sum::<f64>() / n;
    let sum: f64 = without.iter().map(|v| (v - mean).powi(2)).sum();
    let reach = (student_975(n - 1.0) * ((n - 1.0) / n * sum).sqrt()).hypot(slack);
    [value - reach, value + reach]
}

/// 97.5 % quantile of Student's t, by its expansion around the normal one: within 1 % from two degrees of freedom on. Hill
/// (1970), Communications of the ACM 13(10).
fn student_975(freedom: f64) -> f64 {
    let z: f64 = 1.959_964;
    let (first, second) = ((z.powi(3) + z) / 4.0, (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0);
    let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    let fourth = (79.0 * z.powi(9) + 776.0 * z.powi(7) + 1482.0 * z.powi(5) - 1920.0 * z.powi(3) - 945.0 * z) / 92160.0;
    let terms = [z, first, second, third, fourth];
    if freedom < 1.5 { 12.706 } else { terms.iter().rev().fold(0.0, |sum, term| sum / freedom + term) }
}

/// Sum of squares and samples of one block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Sum over samples and outputs.
    pub squares: f64,
    /// Samples.
    pub samples: usize,
}

/// Root mean square over blocks, with its interval.
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

fn root<'p>(parts: impl Iterator<Item = &'p Part>) -> f64 {
    let (squares, samples) = parts.fold((0.0, 0), |(s, n), part| (s + part.squares, n + part.samples));
    if samples > 0 { (squares / samples as f64).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a table of Student's t.
    #[test]
    fn quantiles_of_students_t() {
        for (freedom, t) in [(1.0, 12.706), (2.0, 4.303), (5.0, 2.571), (10.0, 2.228), (30.0, 2.042), (1e9, 1.960)] {
            assert!((student_975(freedom) / t - 1.0).abs() < 0.01, "{freedom}: {}", student_975(freedom));
        }
    }

    /// Oracle: the jackknife of a mean is its textbook standard error.
    #[test]
    fn the_jackknife_of_a_mean() {
        let values = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
        let mean = values.iter().sum::<f64>() / 6.0;
        let without: Vec<f64> = values.iter().map(|v| (6.0 * mean - v) / 5.0).collect();
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 5.0;
        let reach = student_975(5.0) * (variance / 6.0).sqrt();
        let interval = jackknife(mean, &without, 0.0);
        assert!((interval[1] - mean - reach).abs() < 1e-12 && (mean - interval[0] - reach).abs() < 1e-12);
    }

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
