//! Random offsets of trials that no recorded signal explains, as random effects.
//!
//! ```text
//! y_t = f_t + c_t + e_t,  c_t ~ N(0, τ²),   x̃ = x − (1 − ρ) x̄_t,   ρ = (1 + τ²/v)^{−1/2}
//! ```
//!
//! | symbol | meaning                                                                  |
//! | `c_t`  | offset of trial t, one for each output                                   |
//! | `v`    | variance of a trial's mean without it, from the spread of its quarters   |
//! | `x̄_t`  | mean of a column, or of the target, over the trial                       |
//!
//! Least squares of the transformed columns are generalised least squares. New trials are predicted with c = 0. Fuller & Battese
//! (1973), JASA 68.

use nalgebra::DMatrix;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::problem::Problem;

/// Smallest number of trials that offsets are estimated from.
const TRIALS: usize = 4;

/// Number of parts of a trial.
const PARTS: usize = 4;

/// Significance level of offsets.
const LEVEL: f64 = 0.01;

/// Offsets of trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offsets {
    /// Standard deviation τ of all outputs together, weighted.
    pub size: f64,
    /// Share 1 − ρ of each trial's mean that is taken out.
    pub share: f64,
}

/// Estimates offsets from residuals [N × M] of whole trials left out. None where trials are few, or where their means
/// are no larger than their autocorrelation allows.
pub fn offsets(problem: &Problem, residual: &DMatrix<f64>) -> Option<Offsets> {
    let edges = problem.edges();
    let trials: Vec<(usize, usize)> =
        edges.windows(2).map(|pair| (pair[0], pair[1])).filter(|(a, b)| b - a >= 4 * PARTS).collect();
    if trials.len() < TRIALS || !problem.blocks.by_trial {
        return None;
    }
    let (mut between, mut within) = (0.0, 0.0);
    for (first, end) in &trials {
        for column in residual.column_iter() {
            let mean = |a: usize, b: usize| column.rows(a, b - a).mean();
            let cut = |k: usize| first + k * (end - first) / PARTS;
            let parts: Vec<f64> = (0..PARTS).map(|k| mean(cut(k), cut(k + 1))).collect();
            let whole = parts.iter().sum::<f64>() / PARTS as f64;
            let spread = parts.iter().map(|part| (part - whole).powi(2)).sum::<f64>() / (PARTS - 1) as f64;
            between += whole * whole / trials.len() as f64;
            within += spread / (PARTS * trials.len()) as f64;
        }
    }
    let count = trials.len() as f64;
    let chance = FisherSnedecor::new(count, count * (PARTS - 1) as f64).ok()?;
    if within <= 0.0 || chance.sf(between / within) > LEVEL {
        return None;
    }
    let variance = between - within;
    Some(Offsets { size: variance.sqrt(), share: 1.0 - (1.0 + variance / within).sqrt().recip() })
}

/// Takes the share of each column's mean out.
pub fn without_offset(share: f64, mut columns: DMatrix<f64>) -> DMatrix<f64> {
    if share == 0.0 {
        return columns;
    }
    let rows = columns.nrows().max(1);
    for column in columns.as_mut_slice().chunks_mut(rows) {
        let taken = share * sum(column) / rows as f64;
        column.iter_mut().for_each(|value| *value -= taken);
    }
    columns
}

/// Returns a sum of eight partial sums, which a processor forms side by side.
fn sum(values: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let eights = values.chunks_exact(8);
    let rest: f64 = eights.remainder().iter().sum();
    for eight in eights {
        sums.iter_mut().zip(eight).for_each(|(sum, value)| *sum += value);
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::bench;
    use crate::series::Series;
    use acm_core::record::Record;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Returns the residuals of `trials` trials with 40 samples: noise of unit deviation, and planted offsets.
    fn residual(trials: usize, size: f64, seed: u64) -> DMatrix<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || (0..12).map(|_| random.random_range(0.0..1.0)).sum::<f64>() - 6.0;
        let offsets: Vec<f64> = (0..2 * trials).map(|_| size * normal()).collect();
        DMatrix::from_fn(40 * trials, 2, |k, o| offsets[k / 40 * 2 + o] + normal())
    }

    fn trials(count: usize) -> Vec<Series> {
        let record = Record::new((0..40).map(|k| 0.1 * f64::from(k)).collect(), vec![], vec![], vec![]);
        vec![bench::series(record, vec![0.0; 80]); count]
    }

    /// Oracle: the deviation that was drawn, √2 for two outputs; and the share by the variance of a mean of 40 samples.
    #[test]
    fn planted_offsets_are_measured_and_noise_has_none() {
        let (rig, trials) = (bench::rig(&[], &[], &["x", "y"]), trials(60));
        let problem = Problem::new(&rig, &trials, &[1.0, 1.0], None);
        let found = offsets(&problem, &residual(60, 3.0, 1)).unwrap();
        assert!((found.size / (3.0 * 2f64.sqrt()) - 1.0).abs() < 0.15, "{found:?}");
        let truth = 1.0 - (1.0f64 + 9.0 * 40.0).sqrt().recip();
        assert!((found.share - truth).abs() < 0.02, "{found:?}, {truth}");
        let named = (0..100).filter(|seed| offsets(&problem, &residual(60, 0.0, 100 + seed)).is_some()).count();
        assert!(named <= 4, "{named} of 100");
    }

    /// Oracle: the sum of the first n numbers is n (n + 1)/2; half of the mean is taken out.
    #[test]
    fn a_share_of_the_mean_is_taken_out() {
        for rows in [1, 8, 21] {
            let left = without_offset(0.5, DMatrix::from_fn(rows, 2, |k, _| (k + 1) as f64));
            let taken = 0.25 * (rows + 1) as f64;
            assert!((0..rows).all(|k| left[(k, 1)] == (k + 1) as f64 - taken), "{rows}");
        }
        assert_eq!(without_offset(0.5, DMatrix::zeros(0, 2)).ncols(), 2);
    }

    #[test]
    fn three_trials_say_nothing() {
        let (rig, trials) = (bench::rig(&[], &[], &["x", "y"]), trials(3));
        assert_eq!(offsets(&Problem::new(&rig, &trials, &[1.0, 1.0], None), &residual(3, 9.0, 1)), None);
    }
}
