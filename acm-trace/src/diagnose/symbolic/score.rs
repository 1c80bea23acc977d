//! Cross-validated score of a formula.

use nalgebra::{DMatrix, DVector};

use super::Column;
use super::Search;
use super::normal::Normal;

/// Smallest mean gain of all terms together, in standard errors over the blocks (more where blocks are few).
const LEAST_ERRORS: f64 = 2.5;

/// Mean squares on blocks left out.
pub(super) struct Score {
    /// Mean over all blocks.
    pub mean: f64,
    /// Mean square of each block.
    blocks: Vec<f64>,
}

impl Score {
    /// Returns whether the mean gain over blocks is significant.
    pub fn better_than(&self, other: &Self) -> bool {
        let gains: Vec<f64> = self.blocks.iter().zip(&other.blocks).map(|(mine, other)| other - mine).collect();
        let n = gains.len() as f64;
        let mean = gains.iter().sum::<f64>() / n;
        let spread = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
        mean > LEAST_ERRORS * (1.0 + 2.0 / n) * (spread / n).sqrt()
    }
}

impl Search {
    /// Returns the score of a formula.
    pub(super) fn score(&self, chosen: &[Column]) -> Score {
        self.score_of(chosen, None)
    }

    /// Returns the score with a further term: fitted to all blocks but one, scored on that one.
    pub(super) fn score_of(&self, chosen: &[Column], further: Option<&Column>) -> Score {
        let columns: Vec<&Column> = chosen.iter().chain(further).collect();
        let parts: Vec<Normal> = self.blocks.iter().map(|block| self.normal(&columns, block)).collect();
        let all = parts.iter().skip(1).fold(parts[0].clone(), |sum, part| sum.plus(part));
        let left: Vec<f64> = parts
            .iter()
            .map(|part| {
                let coefficients = all.less(part).solve();
                part.squares - 2.0 * coefficients.dot(&part.right) + coefficients.dot(&(&part.gram * &coefficients))
            })
            .collect();
        let samples: usize = self.blocks.iter().map(Vec::len).sum();
        let blocks = left.iter().zip(&self.blocks).map(|(sum, block)| sum / block.len() as f64).collect();
        Score { mean: left.iter().sum::<f64>() / samples as f64, blocks }
    }

    pub(super) fn normal(&self, columns: &[&Column], block: &[usize]) -> Normal {
        let dot = |a: &[f64], b: &[f64]| -> f64 {
            let of = |n: usize| (n * self.outputs..(n + 1) * self.outputs).map(|k| a[k] * b[k]).sum::<f64>();
            block.iter().map(|&n| of(n)).sum()
        };
        let (k, r) = (columns.len(), &self.residual);
        Normal {
            gram: DMatrix::from_fn(k, k, |i, j| dot(&columns[i].values, &columns[j].values)),
            right: DVector::from_fn(k, |i, _| dot(&columns[i].values, r)),
            squares: dot(r, r),
        }
    }
}
