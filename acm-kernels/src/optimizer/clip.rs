//! Clipping of the gradient's global norm.
//!
//! ```text
//! g ← g · min(1, c / (‖g‖ + 10⁻⁶)),   ‖g‖² over all parameters together
//! ```
//!
//! As torch's `clip_grad_norm_`. Pascanu et al. (2013), ICML.

use pulp::{Arch, Simd, WithSimd};

/// Limits `gradient` to the norm `limit`; returns the norm it had.
pub fn clip(gradient: &mut [f32], limit: f64) -> f64 {
    let norm = square(gradient).sqrt();
    let share = limit / (norm + 1e-6);
    if share < 1.0 {
        Arch::new().dispatch(Shorten { gradient, share });
    }
    norm
}

/// Multiplication of every value by `share`, with the widest vectors that the processor has; the width changes no bit.
struct Shorten<'a> {
    gradient: &'a mut [f32],
    share: f64,
}

impl WithSimd for Shorten<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.gradient.iter_mut().for_each(|g| *g = (f64::from(*g) * self.share) as f32);
    }
}

/// Computes Σ g², in eight sums side by side: one after the other, each addition would wait for the one before.
fn square(gradient: &[f32]) -> f64 {
    let (eights, rest) = gradient.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        sums.iter_mut().zip(eight).for_each(|(sum, &g)| *sum += f64::from(g) * f64::from(g));
    }
    let rest: f64 = rest.iter().map(|&g| f64::from(g) * f64::from(g)).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 1² + 2² + … + n² = n (n + 1)(2n + 1)/6.
    #[test]
    fn every_value_counts_once() {
        for n in [0, 1, 7, 8, 9, 21] {
            let gradient: Vec<f32> = (1..=n).map(|g| g as f32).collect();
            assert_eq!(square(&gradient), f64::from(n * (n + 1) * (2 * n + 1) / 6));
        }
    }

    /// Oracle: 3-4-5 triangles. A short gradient is left alone to the bit.
    #[test]
    fn the_norm_is_limited_and_the_direction_kept() {
        let mut gradient = [30.0, 40.0];
        assert_eq!(clip(&mut gradient, 5.0), 50.0);
        assert!((gradient[0] - 3.0).abs() < 1e-6 && (gradient[1] - 4.0).abs() < 1e-6, "{gradient:?}");
        let mut short = [0.3, 0.4];
        clip(&mut short, 5.0);
        assert_eq!(short, [0.3, 0.4]);
    }
}
