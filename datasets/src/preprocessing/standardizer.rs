//! Standardisation to zero mean and unit spread over the training samples only.
//!
//! ```text
//! z = (x − mean) / spread,   spread² = Σ (x − mean)² / n
//! ```
//!
//! The series that it is fitted on are an explicit argument: what is not in the list cannot leak into it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Mean and spread of each column, in the columns' units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Standardizer {
    /// `[C]`.
    pub mean: Vec<f64>,
    /// `[C]`, above 0; 1 for a constant column.
    pub spread: Vec<f64>,
}

impl Standardizer {
    /// Scaler from the rows of all parts, `[T×C]` each, in two passes.
    ///
    /// # Panics
    /// If the parts have different numbers of columns.
    pub fn fit(parts: &[&DMatrix<f64>]) -> Standardizer {
        let mut means = Means::default();
        parts.iter().for_each(|part| means.add(part));
        let mut spreads = means.spreads();
        parts.iter().for_each(|part| spreads.add(part));
        spreads.standardizer()
    }

    /// `(x − mean) / spread`, `[T×C]`.
    pub fn standardize(&self, values: &DMatrix<f64>) -> DMatrix<f64> {
        self.each(values, |x, mean, spread| (x - mean) / spread)
    }

    /// `x · spread + mean`, `[T×C]`.
    pub fn restore(&self, values: &DMatrix<f64>) -> DMatrix<f64> {
        self.each(values, |x, mean, spread| x * spread + mean)
    }

    fn each(&self, values: &DMatrix<f64>, map: impl Fn(f64, f64, f64) -> f64) -> DMatrix<f64> {
        assert_eq!(values.ncols(), self.mean.len(), "columns of the standardizer");
        DMatrix::from_fn(values.nrows(), values.ncols(), |t, c| map(values[(t, c)], self.mean[c], self.spread[c]))
    }
}

/// The first pass: sums of each column, over parts that come one after the other.
#[derive(Debug, Clone, Default)]
pub struct Means {
    rows: usize,
    sums: Vec<f64>,
}

impl Means {
    /// Adds the rows of a part, `[T×C]`.
    ///
    /// # Panics
    /// If it has another number of columns than those before.
    pub fn add(&mut self, part: &DMatrix<f64>) {
        if self.sums.is_empty() {
            self.sums = vec![-0.0; part.ncols()]; // the neutral element, as of `Iterator::sum`
        }
        assert_eq!(part.ncols(), self.sums.len(), "columns of a part");
        self.rows += part.nrows();
        for (sum, column) in self.sums.iter_mut().zip(part.column_iter()) {
            *sum = column.iter().fold(*sum, |sum, x| sum + x);
        }
    }

    /// The second pass, which is to see the same parts.
    pub fn spreads(self) -> Spreads {
        let n = self.rows.max(1) as f64;
        let mean: Vec<f64> = self.sums.iter().map(|sum| sum / n).collect();
        Spreads { rows: self.rows, squares: vec![-0.0; mean.len()], mean }
    }
}

/// The second pass: squares about the means.
#[derive(Debug, Clone)]
pub struct Spreads {
    rows: usize,
    mean: Vec<f64>,
    squares: Vec<f64>,
}

impl Spreads {
    /// Adds the rows of a part, `[T×C]`.
    pub fn add(&mut self, part: &DMatrix<f64>) {
        for ((sum, mean), column) in self.squares.iter_mut().zip(&self.mean).zip(part.column_iter()) {
            *sum = column.iter().fold(*sum, |sum, x| sum + (x - mean) * (x - mean));
        }
    }

    /// Mean and spread of what both passes saw.
    pub fn standardizer(self) -> Standardizer {
        let n = self.rows.max(1) as f64;
        let spread = |(squares, mean): (&f64, &f64)| match (squares / n).sqrt() {
            // rounding of a constant leaves a spread of about 1e-16 of its size
            spread if spread > 1e-12 * mean.abs() => spread,
            _ => 1.0,
        };
        Standardizer { spread: self.squares.iter().zip(&self.mean).map(spread).collect(), mean: self.mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Column 0: 1, 3, 5, 7: mean 4, spread √5. Column 1 is constant. The second part is not a copy.
    #[test]
    fn mean_and_spread_are_those_of_all_rows() {
        let first = DMatrix::from_row_slice(3, 2, &[1.0, 0.1, 3.0, 0.1, 5.0, 0.1]);
        let second = DMatrix::from_row_slice(1, 2, &[7.0, 0.1]);
        let fitted = Standardizer::fit(&[&first, &second]);
        assert_eq!(fitted.mean[0], 4.0);
        assert_eq!(fitted.spread, [5f64.sqrt(), 1.0]);
        let z = fitted.standardize(&second);
        assert!((z[(0, 0)] - 3.0 / 5f64.sqrt()).abs() < 1e-15 && z[(0, 1)].abs() < 1e-15);
        let back = fitted.restore(&z);
        assert!((back - second).amax() < 1e-15);
    }
}
