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
//! | `[ω]`  | cross-product matrix, [ω]u = ω × u        | 3 × 3 | rad  |
//!
//! Below one radian the coefficients are Taylor series in θ², which lose nothing at θ → 0.
//! Sola, Deray, Atchuthan (2018), "A micro Lie theory for state estimation in robotics".

use nalgebra::{Matrix3, Vector3};

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

/// Derivative of the exponential of a twist (ω, v).
///
/// `δR = [spin·δω] R` and `δp = bend·δω + spin·δv`.
#[derive(Debug, Clone, Copy)]
pub struct Tangent {
    /// Left Jacobian of the rotation.
    pub spin: Matrix3<f64>,
    /// Change of the position with the rotation vector, m.
    pub bend: Matrix3<f64>,
}

/// Cross-product matrix: `hat(a) b = a × b`.
pub fn hat(a: &Vector3<f64>) -> Matrix3<f64> {
    a.cross_matrix()
}

/// The rigid motion reached by following the constant twist (ω, v) for unit time.
pub fn exp(omega: &Vector3<f64>, v: &Vector3<f64>) -> Pose {
    let c = Coefficients::at(omega.norm_squared());
    let once = omega.cross(v);
    Pose { rotation: c.rotation(omega), position: v + once * c.b + omega.cross(&once) * c.c }
}

/// [`exp`] together with its derivative.
pub fn exp_with_tangent(omega: &Vector3<f64>, v: &Vector3<f64>) -> (Pose, Tangent) {
    let square = omega.norm_squared();
    let c = Coefficients::at(square);
    let (db, dc) = c.slopes(square);
    let once = omega.cross(v);
    let twice = omega.cross(&once);
    let bend = -hat(v) * c.b - (hat(&once) + hat(omega) * hat(v)) * c.c
        + (once * (2.0 * db) + twice * (2.0 * dc)) * omega.transpose();
    let pose = Pose { rotation: c.rotation(omega), position: v + once * c.b + twice * c.c };
    let spin = c.left_jacobian(omega);
    (pose, Tangent { spin, bend })
}

/// Rotation by the rotation vector `omega`, rad.
pub fn rotation(omega: &Vector3<f64>) -> Matrix3<f64> {
    Coefficients::at(omega.norm_squared()).rotation(omega)
}

/// Left Jacobian of the rotation: `δR = [J·δω] R`.
pub fn left_jacobian(omega: &Vector3<f64>) -> Matrix3<f64> {
    Coefficients::at(omega.norm_squared()).left_jacobian(omega)
}

/// A, B, C of the header at one angle.
struct Coefficients {
    a: f64,
    b: f64,
    c: f64,
}

/// Terms of the Taylor series; at one radian the first term left out is below 1e-20.
const TERMS: usize = 10;
const A: [f64; TERMS] = alternating_factorials(1);
const B: [f64; TERMS] = alternating_factorials(2);
const C: [f64; TERMS] = alternating_factorials(3);

/// Coefficients `(−1)ᵏ / (2k + first)!` of a series in θ².
const fn alternating_factorials(first: usize) -> [f64; TERMS] {
    let mut terms = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        let mut term = if k % 2 == 0 { 1.0 } else { -1.0 };
        let mut factor = 2;
        while factor <= 2 * k + first {
            term /= factor as f64;
            factor += 1;
        }
        terms[k] = term;
        k += 1;
    }
    terms
}

fn horner(terms: &[f64; TERMS], x: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| sum * x + term)
}

/// Derivative of [`horner`] with respect to x.
fn horner_slope(terms: &[f64; TERMS], x: f64) -> f64 {
    (1..TERMS).rev().fold(0.0, |sum, k| sum * x + k as f64 * terms[k])
}

impl Coefficients {
    fn at(square: f64) -> Self {
        if square < 1.0 {
            return Self { a: horner(&A, square), b: horner(&B, square), c: horner(&C, square) };
        }
        let angle = square.sqrt();
        let (sin, cos) = angle.sin_cos();
        Self { a: sin / angle, b: (1.0 - cos) / square, c: (angle - sin) / (square * angle) }
    }

    /// dB/dθ² and dC/dθ².
    fn slopes(&self, square: f64) -> (f64, f64) {
        if square < 1.0 {
            return (horner_slope(&B, square), horner_slope(&C, square));
        }
        let half = 0.5 / square;
        ((self.a - 2.0 * self.b) * half, (self.b - 3.0 * self.c) * half)
    }

    fn rotation(&self, omega: &Vector3<f64>) -> Matrix3<f64> {
        let hat = hat(omega);
        Matrix3::identity() + hat * self.a + hat * hat * self.b
    }

    fn left_jacobian(&self, omega: &Vector3<f64>) -> Matrix3<f64> {
        let hat = hat(omega);
        Matrix3::identity() + hat * self.b + hat * hat * self.c
    }
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

        /// Oracle: central differences of the exponential.
        #[test]
        fn tangent_is_the_derivative(w in turn(), v in vector(), dw in vector(), dv in vector()) {
            let h = 1e-5;
            let (_, tangent) = exp_with_tangent(&w, &v);
            let (after, before) = (exp(&(w + dw * h), &(v + dv * h)), exp(&(w - dw * h), &(v - dv * h)));
            let slope = (after.position - before.position) / (2.0 * h);
            let turned = (after.rotation - before.rotation) / (2.0 * h);
            prop_assert!((tangent.bend * dw + tangent.spin * dv - slope).amax() < 1e-6);
            prop_assert!((hat(&(tangent.spin * dw)) * rotation(&w) - turned).amax() < 1e-6);
        }
    }

    /// Oracle: exp = (1 + x/n)ⁿ carried out as n small products, at an angle on each side of the switch.
    #[test]
    fn both_branches_agree_with_repeated_products() {
        let v = Vector3::new(0.3, -0.2, 0.5);
        for angle in [0.999999, 1.000001, 3.0] {
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
