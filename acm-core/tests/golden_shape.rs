//! Golden forward kinematics: tip, orientation and three places along the arm for seventy strain fields.
//!
//! Oracle: `golden/fk.json`, made by an adaptive Runge–Kutta of order 8 and confirmed by an extended-precision
//! integrator; it states its conventions in its header.

use acm_core::axis::Axis;
use acm_core::se3::Pose;
use acm_core::shape::Shape;
use acm_core::strain::StrainBasis;
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;

const TOLERANCE: f64 = 1e-11;

fn golden() -> Value {
    let path = "tests/golden/fk.json";
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).expect("golden numbers are JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter().filter_map(Value::as_f64).collect()
}

/// κ_1, κ_2 and, where given, the twist.
fn strain(case: &Value) -> Vec<f64> {
    ["c1", "c2", "c3"].iter().flat_map(|key| padded(case, key)).collect()
}

fn padded(case: &Value, key: &str) -> Vec<f64> {
    let functions = case["m"].as_u64().unwrap_or(0) as usize + 1;
    match &case[key] {
        Value::Null => Vec::new(),
        list => {
            let mut list = numbers(list);
            list.resize(functions, 0.0);
            list
        }
    }
}

/// Pose in the frame of the case's reference axis.
fn turned(axis: Axis, pose: &Pose) -> Pose {
    let u = axis.rotation();
    Pose { rotation: u * pose.rotation * u.transpose(), position: u * pose.position }
}

#[test]
fn seventy_strain_fields() {
    let golden = golden();
    let cases = golden["cases"].as_array().expect("a list of cases");
    assert_eq!(cases.len(), 70);
    let mut worst = 0.0f64;
    for case in cases {
        let name = case["name"].as_str().unwrap_or_default();
        let axis: Axis = serde_json::from_value(case["e_b"].clone()).expect("an axis");
        let length = case["L"].as_f64().expect("a length");
        let basis = StrainBasis::Legendre { order: case["m"].as_u64().expect("an order") as usize };
        let c = strain(case);
        let shape = Shape::new(length, basis, &[1.0], 16, Some(1e-12));
        let check = |s: f64, position: &[f64]| {
            let pose = turned(axis, &shape.pose(&c, s));
            let error = (pose.position - Vector3::from_column_slice(position)).norm();
            assert!(error < TOLERANCE, "{name} at s = {s}: {error:e} m");
            (pose, error)
        };
        let (tip, error) = check(length, &numbers(&case["tip"]));
        worst = worst.max(error);
        let rotation = Matrix3::from_row_slice(&numbers(&case["tip_R"]));
        assert!((tip.rotation - rotation).amax() < 1e-10, "{name}: rotation");
        for place in case["mid"].as_array().expect("places along the arm") {
            let s = place["s_over_L"].as_f64().expect("a place") * length;
            worst = worst.max(check(s, &numbers(&place["p"])).1);
        }
    }
    println!("largest error {worst:.1e} m");
}
