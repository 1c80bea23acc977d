//! Zero mean and unit spread, as they were in training: z = (x − mean)/spread.

use serde::{Deserialize, Serialize};

/// Mean and spread of each column, in the columns' units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaler {
    /// One for each column.
    pub mean: Vec<f64>,
    /// Above 0.
    pub spread: Vec<f64>,
}

impl Scaler {
    /// Changes nothing.
    pub fn identity(columns: usize) -> Self {
        Self { mean: vec![0.0; columns], spread: vec![1.0; columns] }
    }

    /// Standardised column `c`, in the precision of networks.
    pub(crate) fn standardise(&self, c: usize, value: f64) -> f32 {
        ((value - self.mean[c]) / self.spread[c]) as f32
    }

    /// Column `c` in its unit again.
    pub(crate) fn restore(&self, c: usize, value: f32) -> f64 {
        f64::from(value) * self.spread[c] + self.mean[c]
    }

    /// Whether it has as many columns, all of them usable.
    pub(crate) fn fits(&self, columns: usize) -> bool {
        let usable = |(mean, spread): (&f64, &f64)| mean.is_finite() && spread.is_finite() && *spread > 0.0;
        self.mean.len() == columns && self.spread.len() == columns && self.mean.iter().zip(&self.spread).all(usable)
    }
}
