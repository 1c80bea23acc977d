//! Standardisation to zero mean and unit spread, with the training values: z = (x − mean)/spread.

use serde::{Deserialize, Serialize};

/// Mean and spread of each column, in the columns' units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaler {
    /// Mean of each column.
    pub mean: Vec<f64>,
    /// Spread of each column, above 0.
    pub spread: Vec<f64>,
}

impl Scaler {
    /// Returns the identity scaler: mean 0, spread 1.
    pub fn identity(columns: usize) -> Self {
        Self { mean: vec![0.0; columns], spread: vec![1.0; columns] }
    }

    /// Returns the standardised value of column `c`, in f32.
    pub(crate) fn standardise(&self, c: usize, value: f64) -> f32 {
        ((value - self.mean[c]) / self.spread[c]) as f32
    }

    /// Returns the value of column `c` in its unit.
    pub(crate) fn restore(&self, c: usize, value: f32) -> f64 {
        f64::from(value) * self.spread[c] + self.mean[c]
    }

    /// Returns whether it has this many columns, all with finite means and positive spreads.
    pub(crate) fn fits(&self, columns: usize) -> bool {
        let usable = |(mean, spread): (&f64, &f64)| mean.is_finite() && spread.is_finite() && *spread > 0.0;
        self.mean.len() == columns && self.spread.len() == columns && self.mean.iter().zip(&self.spread).all(usable)
    }
}
