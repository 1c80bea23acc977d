//! Four elastic tendons that can go slack, and the moments they put on the joints.
//!
//! ```text
//! ℓ_t = Σ_i 2·r·d_ti·sin(θ_i/2)                  what tendon t gives back as the arm bends towards it
//! e_t = T0/k + cmd_t − ℓ_t                       elongation
//! T_t = k·(e_t + √(e_t² + w²))/2                 tension at the servo, zero when slack
//! m_i = Σ_t T_t·share_t·r·d_ti·cos(θ_i/2)        moment on joint coordinate i
//! ```
//!
//! | symbol   | meaning                                            | unit |
//! | `r`      | distance of the tendons from the backbone          | m    |
//! | `d_ti`   | −1, 0 or 1: which tendon bends which coordinate    | 1    |
//! | `cmd_t`  | tendon that the pulley has taken up                | m    |
//! | `w`      | elongation over which slack rope becomes taut      | m    |
//! | `share`  | part of the tension that passes the sheath         | 1    |
//!
//! Tendons run straight from disc to disc, hence sin and cos of half angles (Camarillo et al. 2008, IEEE T-RO 24).

use crate::twin::settings::TendonSettings;

/// Number of tendons.
pub const TENDONS: usize = 4;

/// Coordinate of each joint (0: about x, 1: about y) that each tendon bends, with its sign. In the attachment
/// frame, z down the arm, the tendons lie at +x, −x, −y, +y.
pub const DIRECTIONS: [(usize, f64); TENDONS] = [(1, 1.0), (1, -1.0), (0, 1.0), (0, -1.0)];

/// Tension and its derivative by elongation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tension {
    /// Tension, N.
    pub force: f64,
    /// Stiffness at this elongation, N/m.
    pub stiffness: f64,
}

/// Returns the tension of a rope at an elongation.
pub fn tension(settings: &TendonSettings, elongation: f64) -> Tension {
    let width = elongation.hypot(settings.slack_width);
    // For a slack rope (e + |e|) would cancel; the other form of the same number does not.
    let sum = if elongation > 0.0 {
        elongation + width
    } else {
        settings.slack_width * settings.slack_width / (width - elongation)
    };
    Tension { force: 0.5 * settings.stiffness * sum, stiffness: 0.5 * settings.stiffness * sum / width }
}

/// Returns the tendon length released in a configuration, m.
pub fn give_back(settings: &TendonSettings, angles: &[f64]) -> [f64; TENDONS] {
    let mut sums = [0.0; 2];
    for pair in angles.chunks_exact(2) {
        sums[0] += (0.5 * pair[0]).sin();
        sums[1] += (0.5 * pair[1]).sin();
    }
    DIRECTIONS.map(|(axis, sign)| 2.0 * settings.radius * sign * sums[axis])
}

/// Returns the elongation of a straight arm's tendons that makes the pretension, m.
pub fn preload(settings: &TendonSettings, pretension: f64) -> f64 {
    // Inverse of `tension`: T/k = (e + √(e² + w²))/2  ⇔  e = T/k − w²/(4·T/k).
    let stretch = pretension / settings.stiffness;
    stretch - settings.slack_width * settings.slack_width / (4.0 * stretch)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rope_pulls_but_never_pushes() {
        let settings = TendonSettings::default();
        assert!((tension(&settings, 0.01).force - 22.0).abs() < 3e-3);
        let slack = tension(&settings, -0.01);
        assert!(slack.force > 0.0 && slack.force < 3e-3);
        assert!(tension(&settings, -1.0).force < 1e-4);
    }

    #[test]
    fn preload_makes_the_pretension() {
        let settings = TendonSettings::default();
        let found = tension(&settings, preload(&settings, 2.0)).force;
        assert!((found - 2.0).abs() < 1e-12);
    }

    /// Oracle: central difference.
    #[test]
    fn stiffness_is_the_derivative_of_tension() {
        let settings = TendonSettings::default();
        for elongation in [-1e-3, -1e-4, 0.0, 2e-4, 5e-3] {
            let d = 1e-7;
            let slope =
                (tension(&settings, elongation + d).force - tension(&settings, elongation - d).force) / (2.0 * d);
            assert!((slope - tension(&settings, elongation).stiffness).abs() < 1e-2);
        }
    }

    /// Oracle: tendons at ±r on discs joined at their centres, distances between holes by Pythagoras.
    #[test]
    fn give_back_is_the_geometry_of_the_holes() {
        let settings = TendonSettings::default();
        let angle: f64 = 0.2;
        // Two half-links of length 0 around the joint: the hole at +x moves from (r, 0) to r(cos, −sin) (x, z).
        let (x, z) = (settings.radius * angle.cos() - settings.radius, -settings.radius * angle.sin());
        let chord = x.hypot(z);
        let found = give_back(&settings, &[0.0, angle]);
        assert!((found[0] - chord).abs() < 1e-15);
        assert!((found[1] + chord).abs() < 1e-15);
        assert_eq!(found[2], 0.0);
    }
}
