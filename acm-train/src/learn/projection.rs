//! Shrinkage of a learned correction: projection of the residual on it.
//!
//! ```text
//! λ = clip(⟨r, c⟩ / ⟨c, c⟩, 0, 1)          error(λ) = ⟨r, r⟩ − 2 λ ⟨r, c⟩ + λ² ⟨c, c⟩
//! ```
//!
//! | symbol   | meaning                                                    | shape | unit    |
//! | -------- | ---------------------------------------------------------- | ----- | ------- |
//! | `r`      | residual of the nominal model on the validation part       | [N×O] | m       |
//! | `c`      | what the network adds to the nominal model                 | [N×O] | m       |
//! | `⟨a, b⟩` | mean over the N windows of the sum over the O outputs      | –     | m²      |
//! | `λ`      | factor on the correction                                   | –     | –       |
//! | error    | mean squared distance that is left                         | –     | m²      |
//!
//! λ minimises error(λ) on [0, 1]; error(0) is that of the nominal model.

use std::ops::AddAssign;

use acm_datasets::Standardizer;
use serde::{Deserialize, Serialize};

/// The three products of the head of this file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Projection {
    /// Product ⟨r, r⟩, SI².
    pub residual: f64,
    /// Product ⟨r, c⟩, SI².
    pub along: f64,
    /// Product ⟨c, c⟩, SI².
    pub square: f64,
}

impl Projection {
    /// Returns the sums over some windows of standardised predictions and targets, window after window.
    pub fn of(scaler: &Standardizer, predictions: &[f32], targets: &[f32]) -> Self {
        let mut sums = Self::default();
        let columns = scaler.mean.iter().zip(&scaler.spread).cycle();
        for ((c, r), (mean, spread)) in predictions.iter().zip(targets).zip(columns) {
            let (c, r) = (f64::from(*c) * spread + mean, f64::from(*r) * spread + mean);
            sums += Self { residual: r * r, along: r * c, square: c * c };
        }
        sums
    }

    /// Returns the projection over `n` windows, from the sums over them.
    #[must_use]
    pub fn over(self, n: usize) -> Self {
        let n = n as f64;
        Self { residual: self.residual / n, along: self.along / n, square: self.square / n }
    }

    /// Returns the shrinkage factor λ.
    pub fn factor(&self) -> f64 {
        self.ratio().clamp(0.0, 1.0)
    }

    /// Returns ⟨r, c⟩ / ⟨c, c⟩, 0 where nothing is corrected.
    pub fn ratio(&self) -> f64 {
        if self.square > 0.0 { self.along / self.square } else { 0.0 }
    }

    /// Returns the mean squared distance that is left with a factor, SI².
    pub fn error(&self, factor: f64) -> f64 {
        (self.residual - 2.0 * factor * self.along + factor * factor * self.square).max(0.0)
    }
}

impl AddAssign for Projection {
    fn add_assign(&mut self, other: Self) {
        self.residual += other.residual;
        self.along += other.along;
        self.square += other.square;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a search over factors on numbers in their own unit.
    #[test]
    fn the_factor_is_the_best_between_nothing_and_all() {
        let scaler = Standardizer { mean: vec![0.5, -1.0], spread: vec![2.0, 0.25] };
        let targets = [0.3, -1.2, 1.1, 0.4, -0.7, 2.0];
        for predictions in
            [[0.9, -0.2, 1.9, 0.1, -1.4, 1.0], [0.1, 0.2, 0.3, 0.4, 0.1, 1.0], [-9.0, 9.0, -8.0, 9.0, -9.0, 7.0]]
        {
            let metres = |values: &[f32]| -> Vec<f64> {
                values
                    .iter()
                    .enumerate()
                    .map(|(i, v)| f64::from(*v) * scaler.spread[i % 2] + scaler.mean[i % 2])
                    .collect()
            };
            let (r, c) = (metres(&targets), metres(&predictions));
            let left = |factor: f64| r.iter().zip(&c).map(|(r, c)| (r - factor * c).powi(2)).sum::<f64>() / 3.0;
            let best = (0..=1000).map(|k| f64::from(k) / 1000.0).min_by(|a, b| left(*a).total_cmp(&left(*b))).unwrap();
            let found = Projection::of(&scaler, &predictions, &targets).over(3);
            assert!((found.factor() - best).abs() < 1e-3, "{} and {best}", found.factor());
            assert!((found.error(0.7) - left(0.7)).abs() < 1e-9);
        }
        assert_eq!(Projection::default().factor(), 0.0);
    }
}
