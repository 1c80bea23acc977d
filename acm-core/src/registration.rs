//! Registration: transform from the arm's frame to the measurement frame.
//!
//! ```text
//! p = C·r + p_0,   C = exp([w])
//! ```
//!
//! | symbol | meaning                                            | shape | unit |
//! | `r`    | position in the frame of the arm's mounting        | 3     | m    |
//! | `w`    | rotation vector of C, measurement frame            | 3     | rad  |
//! | `p_0`  | base of the arm, measurement frame                 | 3     | m    |
//!
//! Turning the base about the arm's own axis and turning all bending directions back leaves every
//! marker where it was. The actuation map is free to do the latter, exactly so for piecewise strain and
//! nearly so for Legendre strain with a_1 ≈ a_2. The data then cannot tell the two apart, so the twist
//! about the reference axis is held at zero unless `twist = true`: the actuation map carries it.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::kinematics::axis::Axis;

/// Whether the registration is known or identified.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum RegistrationSpec {
    /// Known beforehand.
    Fixed {
        /// Rotation vector w, rad.
        #[serde(default)]
        rotation: [f64; 3],
        /// Base p_0, m.
        #[serde(default)]
        translation: [f64; 3],
    },
    /// Identified from the calibration data.
    Identified {
        /// Also identify the rotation about the arm's axis.
        #[serde(default)]
        twist: bool,
    },
}

impl Default for RegistrationSpec {
    fn default() -> Self {
        Self::Identified { twist: false }
    }
}

impl RegistrationSpec {
    /// Which of tilt x, tilt y, twist, base x, y, z are identified.
    pub fn identified(&self) -> [bool; 6] {
        match *self {
            Self::Fixed { .. } => [false; 6],
            Self::Identified { twist } => [true, true, twist, true, true, true],
        }
    }

    /// Parameters before any fit: the known ones, or zeros.
    pub fn start(&self, axis: Axis) -> [f64; 6] {
        let Self::Fixed { rotation, translation } = *self else {
            return [0.0; 6];
        };
        let w = axis.rotation().transpose() * Vector3::from(rotation);
        [w.x, w.y, w.z, translation[0], translation[1], translation[2]]
    }
}

/// Names and units of the six parameters: the rotation vector in the arm's own frame, then the base.
pub const PARAMETERS: [(&str, &str); 6] =
    [("tilt_x", "rad"), ("tilt_y", "rad"), ("twist", "rad"), ("base_x", "m"), ("base_y", "m"), ("base_z", "m")];
