//! Increments of a signal: motion, or noise.
//!
//! ```text
//! Δ_k = x_k − x_{k−1}          ρ = Σ Δ_k Δ_{k+1} / Σ Δ_k²
//! ```
//!
//! ρ is near 1 where a signal is smooth, 0 where its steps are independent, and −1/2 where it is noise about a constant. Steps with
//! a share s of noise in their variance have ρ = −s/2.

use std::iter::Sum;

/// Products of the increments of a signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Increments {
    /// Sum of Δ_k², SI².
    pub square: f64,
    /// Sum of Δ_k Δ_{k+1}, SI².
    pub successive: f64,
}

impl Increments {
    /// Returns the products over successive samples.
    pub fn of(values: &[f64]) -> Self {
        let increments: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let square = increments.iter().map(|own| own * own).sum();
        Self { square, successive: increments.windows(2).map(|pair| pair[0] * pair[1]).sum() }
    }

    /// Returns whether at least half of the variance is motion: ρ ≥ −1/4. The rate of any other signal is noise.
    pub fn are_motion(&self) -> bool {
        self.square > 0.0 && self.successive >= -self.square / 4.0
    }
}

impl Sum for Increments {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, own| Self {
            square: sum.square + own.square,
            successive: sum.successive + own.successive,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand: increments 1, 2, −1.
    #[test]
    fn products_of_increments() {
        assert_eq!(Increments::of(&[0.0, 1.0, 3.0, 2.0]), Increments { square: 6.0, successive: 0.0 });
        assert!(!Increments::of(&[2.0, 2.0, 2.0]).are_motion());
    }

    /// Oracle: the definition. A sine of 40 samples is motion; with noise of three times its increments it is none.
    #[test]
    fn noise_is_no_motion() {
        let noise = |k: usize| [0.3, -1.1, 0.8, 0.1, -0.6, 1.2, -0.7][k % 7];
        let signal = |noisy: f64| -> Vec<f64> {
            (0..400).map(|k| (std::f64::consts::TAU * k as f64 / 40.0).sin() + noisy * noise(k)).collect()
        };
        assert!(Increments::of(&signal(0.0)).are_motion());
        assert!(Increments::of(&signal(0.02)).are_motion());
        assert!(!Increments::of(&signal(0.3)).are_motion());
    }
}
