//! Sums over samples of all terms at all places at once.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::Search;
use crate::tall::product;

/// Directions whose products are computed together.
const TOGETHER: usize = 16;

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

    /// Returns the squared norms of every term at every place along orthonormal directions.
    pub(super) fn squares_along(&self, directions: &[Vec<f64>]) -> DMatrix<f64> {
        let samples = self.residual.len() / self.outputs;
        let places = self.actuators + self.outputs;
        let values: Vec<f64> = self.terms.iter().flat_map(|term| term.values.iter().copied()).collect();
        let values = DMatrix::from_vec(samples, self.terms.len(), values);
        let of = |directions: &[Vec<f64>]| {
            let weight = |n: usize, column: usize| {
                let (vector, place) = (&directions[column / places], column % places);
                (0..self.outputs).map(|m| self.weight(n, m, place) * vector[n * self.outputs + m]).sum()
            };
            let products = product(&values, &DMatrix::from_fn(samples, directions.len() * places, weight), 0..samples);
            let square = |term: usize, place: usize| {
                (0..directions.len()).map(|k| products[(term, k * places + place)].powi(2)).sum()
            };
            DMatrix::from_fn(self.terms.len(), places, square)
        };
        let parts: Vec<DMatrix<f64>> = directions.par_chunks(TOGETHER).map(of).collect();
        parts.iter().fold(DMatrix::zeros(self.terms.len(), places), |sum, part| sum + part)
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
