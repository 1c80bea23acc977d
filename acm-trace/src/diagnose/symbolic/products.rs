//! Sums over samples of all terms at all places at once.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::Search;

impl Search {
    /// Returns the inner products of every term at every place with a vector of N·M.
    pub(super) fn products(&self, vector: &[f64]) -> DMatrix<f64> {
        let weight = |n: usize, place: usize| {
            (0..self.outputs).map(|m| self.weight(n, m, place) * vector[n * self.outputs + m]).sum()
        };
        self.summed(weight, |x| x)
    }

    /// Returns the squared norms of every term at every place.
    pub(super) fn squares(&self) -> DMatrix<f64> {
        let weight = |n: usize, place: usize| (0..self.outputs).map(|m| self.weight(n, m, place).powi(2)).sum();
        self.summed(weight, |x| x * x)
    }

    /// Computes Σ_n of(φ(n)) · weight(n, place).
    fn summed(&self, weight: impl Fn(usize, usize) -> f64, of: fn(f64) -> f64) -> DMatrix<f64> {
        let samples = self.residual.len() / self.outputs;
        let weights = DMatrix::from_fn(samples, self.actuators + self.outputs, weight);
        let rows: Vec<Vec<f64>> = self
            .terms
            .par_iter()
            .map(|term| {
                let sum = |column: &[f64]| term.values.iter().zip(column).map(|(x, w)| of(*x) * w).sum();
                weights.as_slice().chunks_exact(samples).map(sum).collect()
            })
            .collect();
        DMatrix::from_fn(rows.len(), weights.ncols(), |term, place| rows[term][place])
    }
}
