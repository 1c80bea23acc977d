//! Rigid motions and their exponential.
//!
//! ```text
//! exp(ω, v) = (R, p),   R = I + A[ω] + B[ω]²,   p = J v,   J = I + B[ω] + C[ω]²
//! A = sin θ / θ,   B = (1 − cos θ) / θ²,   C = (θ − sin θ) / θ³,   θ = |ω|
//! ```
//!
//! | symbol | meaning                                   | shape | unit |
//! | `ω`    | rotation vector                           | 3     | rad  |
//! | `v`    | translation part of the twist             | 3     | m    |
//! | `J`    | left Jacobian of the rotation             | 3 × 3 | 1    |
//! | `[ω]`  | cross-product matrix, `[ω]`u = ω × u        | 3 × 3 | rad  |
//!
//! Below two radians the coefficients rest on Taylor series in θ², which lose nothing at θ → 0: the functions of one file,
//! `coefficients.rs`. Sola, Deray, Atchuthan (2018), "A micro Lie theory for state estimation in robotics".

use nalgebra::{Matrix3, Vector3};

use crate::kinematics::coefficients::Coefficients;

/// A frame: its rotation and its origin, seen from the frame that it is expressed in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Columns are the axes of the frame.
    pub rotation: Matrix3<f64>,
    /// Origin of the frame, m.
    pub position: Vector3<f64>,
}

impl Pose {
    /// The frame that all others are measured from.
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), position: Vector3::zeros() }
    }

    /// `self` followed by `next`, which is expressed in `self`.
    pub fn then(&self, next: &Pose) -> Pose {
        Pose { rotation: self.rotation * next.rotation, position: self.position + self.rotation * next.position }
    }

    /// A point given in this frame, seen from outside.
    pub fn apply(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * point + self.position
    }

    /// The motion that undoes this one.
    pub fn inverse(&self) -> Pose {
        let rotation = self.rotation.transpose();
        Pose { rotation, position: -(rotation * self.position) }
    }
}

/// Cross-product matrix: `hat(a) b = a × b`.
pub fn hat(a: &Vector3<f64>) -> Matrix3<f64> {
    a.cross_matrix()
}

/// The rigid motion reached by following the constant twist (ω, v) for unit time.
#[inline(always)]
pub fn exp(omega: &Vector3<f64>, v: &Vector3<f64>) -> Pose {
    let c = Coefficients::at(omega.norm_squared());
    let once = omega.cross(v);
    Pose { rotation: rotated(&c, omega), position: v + once * c.b + omega.cross(&once) * c.c }
}

/// Rotation by the rotation vector `omega`, rad.
pub fn rotation(omega: &Vector3<f64>) -> Matrix3<f64> {
    rotated(&Coefficients::at(omega.norm_squared()), omega)
}

/// Left Jacobian of the rotation: `δR = [J·δω] R`.
pub fn left_jacobian(omega: &Vector3<f64>) -> Matrix3<f64> {
    let (c, hat) = (Coefficients::at(omega.norm_squared()), hat(omega));
    Matrix3::identity() + hat * c.b + hat * hat * c.c
}

/// I + A[ω] + B[ω]² with [ω]² = ωωᵀ − θ²I written out.
#[inline(always)]
fn rotated(c: &Coefficients<f64>, omega: &Vector3<f64>) -> Matrix3<f64> {
    let (turn, bent) = (omega * c.a, omega * c.b);
    let (xx, yy, zz) = (bent.x * omega.x, bent.y * omega.y, bent.z * omega.z);
    let (xy, yz, zx) = (bent.x * omega.y, bent.y * omega.z, bent.z * omega.x);
    Matrix3::new(
        1.0 - (yy + zz),
        xy - turn.z,
        zx + turn.y,
        xy + turn.z,
        1.0 - (xx + zz),
        yz - turn.x,
        zx - turn.y,
        yz + turn.x,
        1.0 - (xx + yy),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        (-6.0..6.0f64, -6.0..6.0f64, -6.0..6.0f64).prop_map(|(x, y, z)| Vector3::new(x, y, z))
    }

    /// A rotation vector of any magnitude from 1e-17 to 10 rad.
    fn turn() -> impl Strategy<Value = Vector3<f64>> {
        (vector(), -17.0..0.0f64).prop_map(|(w, power)| w * 10f64.powf(power))
    }

    proptest! {
        #[test]
        fn rotations_are_orthonormal(w in turn(), v in vector()) {
            let r = exp(&w, &v).rotation;
            prop_assert!((r * r.transpose() - Matrix3::identity()).amax() < 1e-14);
            prop_assert!((r.determinant() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn the_negative_twist_undoes_the_twist(w in turn(), v in vector()) {
            let both = exp(&w, &v).then(&exp(&-w, &-v));
            prop_assert!((both.rotation - Matrix3::identity()).amax() < 1e-14);
            prop_assert!(both.position.amax() < 1e-13);
        }

        /// Oracle: Rodrigues' formula as nalgebra implements it.
        #[test]
        fn agrees_with_nalgebra(w in turn()) {
            let theirs = nalgebra::Rotation3::new(w).into_inner();
            prop_assert!((rotation(&w) - theirs).amax() < 1e-14);
        }

        /// Oracle: central differences of the rotation.
        #[test]
        fn the_left_jacobian_is_the_derivative(w in turn(), dw in vector()) {
            let h = 1e-5;
            let turned = (rotation(&(w + dw * h)) - rotation(&(w - dw * h))) / (2.0 * h);
            prop_assert!((hat(&(left_jacobian(&w) * dw)) * rotation(&w) - turned).amax() < 1e-6);
        }
    }

    /// Oracle: exp = (1 + x/n)ⁿ carried out as n small products, at an angle on each side of the switch.
    #[test]
    fn both_branches_agree_with_repeated_products() {
        let v = Vector3::new(0.3, -0.2, 0.5);
        for angle in [0.5, 1.999999, 2.000001, 3.0] {
            let w = Vector3::new(0.6, 0.0, -0.8) * angle;
            let mut power = exp(&(w / 1024.0), &(v / 1024.0));
            for _ in 0..10 {
                power = power.then(&power);
            }
            let direct = exp(&w, &v);
            assert!((power.position - direct.position).amax() < 1e-13);
            assert!((power.rotation - direct.rotation).amax() < 1e-13);
        }
    }

    /// Oracle: first terms of the series by hand, at an angle where 1 − cos θ is zero in f64.
    #[test]
    fn tiny_angles_keep_every_digit() {
        let pose = exp(&Vector3::new(1e-12, 0.0, 0.0), &Vector3::new(0.0, 0.0, 0.5));
        assert_eq!(pose.position.y, -0.25e-12);
        assert_eq!(pose.rotation[(2, 1)], 1e-12);
    }
}
