//! Standardisation: zero mean and unit spread over the samples of the training part, and of nothing else.
//!
//! ```text
//! z = (x − mean) / spread,   spread² = Σ (x − mean)² / n
//! ```
//!
//! The series that it is fitted on are an explicit argument: what is not in the list cannot leak into it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::series::Series;

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
    /// From the inputs of the training series.
    pub fn of_inputs(training: &[&Series]) -> Standardizer {
        Standardizer::fit(&training.iter().map(|s| &s.inputs).collect::<Vec<_>>())
    }

    /// From the targets of the training series.
    pub fn of_targets(training: &[&Series]) -> Standardizer {
        Standardizer::fit(&training.iter().map(|s| &s.target).collect::<Vec<_>>())
    }

    /// From the rows of all parts, `[T×C]` each, in two passes.
    ///
    /// # Panics
    /// If the parts have different numbers of columns.
    pub fn fit(parts: &[&DMatrix<f64>]) -> Standardizer {
        let columns = parts.first().map_or(0, |p| p.ncols());
        let rows: usize = parts.iter().map(|p| p.nrows()).sum();
        let n = rows.max(1) as f64;
        let (mut mean, mut spread) = (vec![0.0; columns], vec![1.0; columns]);
        for c in 0..columns {
            let values = || parts.iter().flat_map(|p| p.column(c).into_iter().copied());
            let m = values().sum::<f64>() / n;
            let s = (values().map(|x| (x - m) * (x - m)).sum::<f64>() / n).sqrt();
            mean[c] = m;
            // rounding of a constant leaves a spread of about 1e-16 of its size
            if s > 1e-12 * m.abs() {
                spread[c] = s;
            }
        }
        Standardizer { mean, spread }
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
