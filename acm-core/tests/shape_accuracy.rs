//! Accuracy of the integrator against closed forms, its order of convergence, and its derivative.

use acm_core::se3::{self, Pose};
use acm_core::shape::Shape;
use acm_core::strain::StrainBasis;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

fn tip(shape: &Shape, c: &[f64]) -> Vector3<f64> {
    let mut out = [Vector3::zeros()];
    shape.positions(c, &mut shape.scratch(c.len()), &mut out);
    out[0]
}

/// Oracle: an arc of constant curvature k bends to x = (1 − cos kL)/k, z = sin kL/k.
#[test]
fn constant_curvature_is_a_circle_in_one_step() {
    let length = 0.62;
    let constant = Shape::new(length, StrainBasis::Legendre { order: 0 }, &[1.0], 1, None);
    for k in [-8.0f64, -0.3, 1.7, 20.0] {
        let expected = Vector3::new((1.0 - (k * length).cos()) / k, 0.0, (k * length).sin() / k);
        assert!((tip(&constant, &[0.0, k]) - expected).norm() < 1e-15);
    }
}

/// Oracle: each segment is a circle; the chain of circles is put together by hand.
#[test]
fn piecewise_constant_curvature_is_a_chain_of_circles() {
    let (length, k1, k2) = (0.6, 3.0f64, -5.0f64);
    let basis = StrainBasis::Piecewise { segments: 2 };
    let shape = Shape::new(length, basis, &[1.0], 7, None);
    let (a, half) = (k1 * 0.3, 0.3);
    let first = Vector3::new((1.0 - a.cos()) / k1, 0.0, a.sin() / k1);
    let b = k2 * half;
    let (x, z) = ((1.0 - b.cos()) / k2, b.sin() / k2);
    let second = Vector3::new(a.cos() * x + a.sin() * z, 0.0, -a.sin() * x + a.cos() * z);
    let found = tip(&shape, &[0.0, 0.0, k1, k2]);
    assert!((found - first - second).norm() < 1e-15);
}

/// Oracle: halving the step divides the error by 64, as the page claims; a very fine grid stands for the truth.
#[test]
fn varying_strain_converges_at_sixth_order() {
    let c = [3.0, 2.7, -1.0, 0.4, -2.0, 0.8, 0.5, -0.6];
    let basis = StrainBasis::Legendre { order: 3 };
    let at = |steps| tip(&Shape::new(0.5, basis, &[1.0], steps, None), &c);
    let truth = at(512);
    let error = |steps| (at(steps) - truth).norm();
    let order = (error(16) / error(32)).log2();
    println!("measured order {order:.3}");
    assert!((order - 6.0).abs() < 0.1, "measured order {order:.3}");
}

/// Oracle: planar bending integrates to an angle, and the position is a quadrature, done here by Simpson's rule.
#[test]
fn the_default_step_count_is_accurate_to_a_micrometre() {
    let (length, c) = (0.62, [0.0, 0.0, 4.0, 6.0]);
    let angle = |s: f64| {
        let u = s / length;
        c[2] * s + c[3] * length * (u * u - u)
    };
    let n = 20_000;
    let h = length / n as f64;
    let weight = |k: usize| match k {
        0 => 1.0,
        k if k == n => 1.0,
        k => 2.0 + 2.0 * (k % 2) as f64,
    };
    let sum = |f: fn(f64) -> f64| (0..=n).map(|k| weight(k) * f(angle(k as f64 * h))).sum::<f64>() * h / 3.0;
    let expected = Vector3::new(sum(f64::sin), 0.0, sum(f64::cos));
    let steps = acm_core::ArmSpec::default().steps;
    let shape = Shape::new(length, StrainBasis::Legendre { order: 1 }, &[1.0], steps, None);
    let error = (tip(&shape, &c) - expected).norm();
    println!("{steps} steps: {error:.1e} m");
    assert!(error < 1e-6, "{error:e}");
    let fine = Shape::new(length, StrainBasis::Legendre { order: 1 }, &[1.0], steps, Some(1e-10));
    assert!((tip(&fine, &c) - expected).norm() < 1e-10);
}

/// Oracle: the frame's equation R' = R [κ], r' = R e_z, by the classical Runge–Kutta method in 400 small steps.
fn by_runge_kutta(length: f64, c: [f64; 4]) -> Vector3<f64> {
    let (steps, mut rotation, mut position) = (400, Matrix3::identity(), Vector3::zeros());
    let h = length / f64::from(steps);
    let turned = |rotation: Matrix3<f64>, s: f64| {
        let p1 = 2.0 * s / length - 1.0;
        let (x, y) = (c[0] + c[1] * p1, c[2] + c[3] * p1);
        rotation * Matrix3::new(0.0, 0.0, y, 0.0, 0.0, -x, -y, x, 0.0)
    };
    for k in 0..steps {
        let s = f64::from(k) * h;
        let k1 = turned(rotation, s);
        let k2 = turned(rotation + k1 * (0.5 * h), s + 0.5 * h);
        let k3 = turned(rotation + k2 * (0.5 * h), s + 0.5 * h);
        let k4 = turned(rotation + k3 * h, s + h);
        let mean: Matrix3<f64> = rotation + (k1 + k2 + k3) * (h / 6.0);
        position += mean.column(2) * h;
        rotation += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
    }
    position
}

/// Both curvatures up to 4 rad/m at the middle and 8 rad/m at the ends. The error is largest at the borders of this domain, and
/// almost no pose of the paper's arm gets near them.
#[test]
fn the_default_steps_are_within_a_micrometre_over_the_domain() {
    let arm = acm_core::ArmSpec::default();
    let shape = Shape::new(arm.length, arm.strain, &[1.0], arm.steps, None);
    let values = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let mut worst = 0.0f64;
    for a1 in [0.0, 2.0, 4.0] {
        for a2 in [-4.0, -2.0, 4.0] {
            for (s1, s2) in values.iter().flat_map(|s1| values.iter().map(move |s2| (s1, s2))) {
                let c = [a1, a1 * s1, a2, a2 * s2];
                worst = worst.max((tip(&shape, &c) - by_runge_kutta(arm.length, c)).norm());
            }
        }
    }
    println!("{} steps: at most {worst:.1e} m", arm.steps);
    assert!(worst < 1e-6, "{worst:e}");
}

/// Markers stop the integration where they are; their poses do not depend on the order in which they are asked for.
#[test]
fn markers_lie_on_the_backbone() {
    let c = [2.0, -1.0, 0.5, 3.0];
    let basis = StrainBasis::Legendre { order: 1 };
    let shape = Shape::new(0.5, basis, &[1.0, 0.31, 0.77], 24, Some(1e-11));
    let mut out = [Pose::identity(); 3];
    shape.poses(&c, &mut shape.scratch(4), &mut out);
    for (pose, at) in out.iter().zip([1.0, 0.31, 0.77]) {
        assert!((pose.position - shape.pose(&c, at * 0.5).position).norm() < 1e-10);
    }
    let none = shape.pose(&c, 0.0);
    assert_eq!(none, Pose::identity());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Oracle: central differences, with and without twist, for both bases and two markers.
    #[test]
    fn jacobian_is_the_derivative(
        c in proptest::collection::vec(-6.0..6.0f64, 9),
        small in -12.0..0.0f64,
        twist in proptest::bool::ANY,
        piecewise in proptest::bool::ANY,
    ) {
        let basis = if piecewise {
            StrainBasis::Piecewise { segments: 3 }
        } else {
            StrainBasis::Legendre { order: 2 }
        };
        let c: Vec<f64> = c.iter().take(if twist { 9 } else { 6 }).map(|c| c * 10f64.powf(small)).collect();
        let shape = Shape::new(0.5, basis, &[1.0, 0.4], 6, None);
        let mut scratch = shape.scratch(c.len());
        let mut out = [Vector3::zeros(); 2];
        let mut slopes = vec![Vector3::zeros(); 2 * c.len()];
        shape.jacobian(&c, &mut scratch, &mut out, &mut slopes);
        let h = 1e-5;
        for j in 0..c.len() {
            let mut moved = |by: f64| {
                let mut c = c.clone();
                c[j] += by;
                let mut out = [Vector3::zeros(); 2];
                shape.positions(&c, &mut scratch, &mut out);
                out
            };
            let (after, before) = (moved(h), moved(-h));
            for marker in 0..2 {
                let slope = (after[marker] - before[marker]) / (2.0 * h);
                prop_assert!((slopes[marker * c.len() + j] - slope).norm() < 1e-8);
            }
        }
    }

    /// Oracle: an arm of unit stretch is never longer than its length, and its frames stay orthonormal.
    #[test]
    fn the_tip_stays_within_reach(c in proptest::collection::vec(-15.0..15.0f64, 6), s in 0.0..=1.0f64) {
        let shape = Shape::new(0.5, StrainBasis::Legendre { order: 2 }, &[1.0], 32, Some(1e-9));
        let pose = shape.pose(&c, 0.5 * s);
        prop_assert!(pose.position.norm() <= 0.5 * s + 1e-8);
        let gram = pose.rotation * pose.rotation.transpose();
        prop_assert!((gram - se3::rotation(&Vector3::zeros())).amax() < 1e-11);
    }
}
