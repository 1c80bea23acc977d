//! A corner with a radius: max(0, d) whose kink is a parabola.
//!
//! ```text
//! c_ρ(d) = 0 for d ≤ −ρ,   (d + ρ)²/(4ρ) between,   d for d ≥ ρ
//! ```
//!
//! It is continuous with its slope, and max(0, d) without a radius. Zang (1980), Mathematical Programming 19,
//! smooths max so.

use crate::effects::ParameterSpec;

/// Returns c_ρ(d) for a radius ρ ≥ 0.
pub fn rounded(d: f64, radius: f64) -> f64 {
    if d >= radius {
        d
    } else if d <= -radius {
        0.0
    } else {
        (d + radius).powi(2) / (4.0 * radius)
    }
}

/// Returns the parameter: ρ as a share of the width that the corner ends. Stops and thresholds may be sharp.
pub fn roundness() -> ParameterSpec {
    ParameterSpec::shape("roundness", "1", 0.2, 0.2).within(0.0, 1.0).from_limit()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, and by differences at both ends of the parabola.
    #[test]
    fn a_corner_is_smooth_and_ends_in_its_lines() {
        assert_eq!([-1.0, -0.2, 0.0, 0.2, 1.0].map(|d| rounded(d, 0.0)), [0.0, 0.0, 0.0, 0.2, 1.0]);
        assert!((rounded(0.0, 0.4) - 0.1).abs() < 1e-15 && (rounded(0.2, 0.4) - 0.225).abs() < 1e-15);
        for (at, slope) in [(-0.4, 0.0), (0.4, 1.0)] {
            let (step, middle) = (1e-6, rounded(at, 0.4));
            let sides = [middle - rounded(at - step, 0.4), rounded(at + step, 0.4) - middle];
            assert!(sides.iter().all(|side| (side / step - slope).abs() < 1e-5), "{at}: {sides:?}");
        }
    }
}
