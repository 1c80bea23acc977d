//! Limiting the gradient's global norm.
//!
//! ```text
//! g ← g · min(1, c / (‖g‖ + 10⁻⁶)),   ‖g‖² over all parameters together
//! ```
//!
//! As torch's `clip_grad_norm_`. Pascanu et al. (2013), ICML.

/// Limits `gradient` to the norm `limit`; returns the norm it had.
pub fn clip(gradient: &mut [f32], limit: f64) -> f64 {
    let norm = gradient.iter().map(|&g| f64::from(g) * f64::from(g)).sum::<f64>().sqrt();
    let share = limit / (norm + 1e-6);
    if share < 1.0 {
        gradient.iter_mut().for_each(|g| *g = (f64::from(*g) * share) as f32);
    }
    norm
}

#[cfg(test)]
mod tests {
    use super::*;

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
