//! Reference axis: where the straight arm points.
//!
//! Strain, shape and pose are computed with the arm along +z, and turned onto the axis afterwards:
//! κ = U·(c_1, c_2, c_3), ν = U·e_z. The positive axes are cyclic permutations, so that x, y, z have
//! κ = (c_3, c_1, c_2), (c_2, c_3, c_1), (c_1, c_2, c_3); a negative axis is the positive one after
//! half a turn about the first bending axis. U holds only 0 and ±1, and loses no bit.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// One of the six coordinate directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Axis {
    /// Along +x.
    #[serde(rename = "x")]
    X,
    /// Along +y.
    #[serde(rename = "y")]
    Y,
    /// Along +z.
    #[default]
    #[serde(rename = "z")]
    Z,
    /// Along −x.
    #[serde(rename = "-x")]
    MinusX,
    /// Along −y.
    #[serde(rename = "-y")]
    MinusY,
    /// Along −z, as an arm that hangs in a frame whose z points up.
    #[serde(rename = "-z")]
    MinusZ,
}

impl Axis {
    /// All six, for tests and messages.
    pub const ALL: [Axis; 6] = [Axis::X, Axis::Y, Axis::Z, Axis::MinusX, Axis::MinusY, Axis::MinusZ];

    /// Unit vector e_b.
    pub fn unit(&self) -> Vector3<f64> {
        self.rotation() * Vector3::z()
    }

    /// Rotation U that takes the arm's own frame (along +z) onto this axis.
    pub fn rotation(&self) -> Matrix3<f64> {
        match self {
            Axis::X | Axis::MinusX => Matrix3::new(0., 0., 1., 1., 0., 0., 0., 1., 0.) * self.flip(),
            Axis::Y | Axis::MinusY => Matrix3::new(0., 1., 0., 0., 0., 1., 1., 0., 0.) * self.flip(),
            Axis::Z | Axis::MinusZ => self.flip(),
        }
    }

    /// Half a turn about the first bending axis where the axis is negative.
    fn flip(&self) -> Matrix3<f64> {
        let sign = match self {
            Axis::X | Axis::Y | Axis::Z => 1.0,
            _ => -1.0,
        };
        Matrix3::from_diagonal(&Vector3::new(1.0, sign, sign))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_points_where_its_name_says() {
        let expected = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
        for (axis, unit) in Axis::ALL.iter().zip(expected) {
            assert_eq!(axis.unit(), Vector3::from(unit));
            assert_eq!(axis.rotation().determinant(), 1.0, "{axis:?}");
            assert_eq!(axis.rotation() * axis.rotation().transpose(), Matrix3::identity());
        }
    }

    #[test]
    fn reads_and_writes_the_sign() {
        assert_eq!(serde_json::to_string(&Axis::MinusZ).ok().as_deref(), Some("\"-z\""));
        assert!(serde_json::from_str::<Axis>("\"w\"").is_err());
    }
}
