//! The tip model: its derivative, its registration, and what it refuses.

use acm_core::axis::Axis;
use acm_core::registration::RegistrationSpec;
use acm_core::strain::StrainBasis;
use acm_core::{ArmSpec, StrainModel};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

fn arm(strain: StrainBasis, axis: Axis) -> ArmSpec {
    ArmSpec {
        length: 0.5,
        axis,
        strain,
        degree: 2,
        steps: 6,
        registration: RegistrationSpec::Identified { twist: true },
        ..ArmSpec::default()
    }
}

/// Parameters of a plausible size, all different.
fn plausible(model: &StrainModel, seed: f64) -> Vec<f64> {
    (0..model.parameters().len()).map(|j| 1.5 * (seed + 1.7 * j as f64).sin()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// Oracle: central differences of the predicted markers, parameter by parameter.
    #[test]
    fn slopes_are_the_derivative(
        which in 0..3usize,
        axis in 0..6usize,
        seed in 0.0..6.0f64,
        q in proptest::collection::vec(-1.5..1.5f64, 2),
    ) {
        let bases = [
            StrainBasis::Legendre { order: 0 },
            StrainBasis::Legendre { order: 2 },
            StrainBasis::Piecewise { segments: 3 },
        ];
        let model = StrainModel::new(&arm(bases[which], Axis::ALL[axis]), 2, &[0.4, 1.0]).unwrap();
        let theta = plausible(&model, seed);
        let mut scratch = model.scratch();
        let (mut out, width) = (vec![0.0; 6], theta.len());
        let mut slopes = vec![0.0; 6 * width];
        model.jacobian_with(&theta, &q, &mut scratch, &mut out, &mut slopes);
        let mut direct = vec![0.0; 6];
        model.predict_with(&theta, &q, &mut scratch, &mut direct);
        prop_assert_eq!(&direct, &out);
        for j in 0..width {
            let mut moved = |by: f64| {
                let mut theta = theta.clone();
                theta[j] += by;
                let mut out = vec![0.0; 6];
                model.predict_with(&theta, &q, &mut scratch, &mut out);
                out
            };
            let (after, before) = (moved(1e-5), moved(-1e-5));
            for o in 0..6 {
                let slope = (after[o] - before[o]) / 2e-5;
                prop_assert!((slopes[o * width + j] - slope).abs() < 1e-8, "output {} parameter {}", o, j);
            }
        }
    }
}

/// Oracle: a straight arm, turned by nalgebra's rotation and moved, written out by hand.
#[test]
fn a_straight_arm_lies_along_its_turned_axis() {
    let (rotation, translation) = ([0.2, -0.4, 0.3], [0.1, 0.2, -0.7]);
    for axis in Axis::ALL {
        let spec = ArmSpec {
            registration: RegistrationSpec::Fixed { rotation, translation },
            ..arm(StrainBasis::Legendre { order: 1 }, axis)
        };
        let model = StrainModel::new(&spec, 2, &[0.5, 1.0]).unwrap();
        let mut out = [0.0; 6];
        model.predict(&[0.3, 0.1], &mut model.scratch(), &mut out);
        let turned = Rotation3::new(Vector3::from(rotation)) * axis.unit();
        for (k, s) in [0.25, 0.5].iter().enumerate() {
            let expected = Vector3::from(translation) + turned * *s;
            let found = Vector3::from_column_slice(&out[3 * k..3 * k + 3]);
            assert!((found - expected).norm() < 1e-15, "{axis:?}");
        }
        let tip = model.pose(&[0.3, 0.1], 0.5);
        assert!((tip.rotation * axis.unit() - turned).norm() < 1e-14);
    }
}

/// Oracle: the paper's formula for κ_i(s) with P_1(u) = 2u − 1, P_2(u) = 6u² − 6u + 1, by hand.
#[test]
fn strain_follows_the_papers_formula() {
    let model = StrainModel::new(&arm(StrainBasis::Legendre { order: 2 }, Axis::Z), 1, &[1.0]).unwrap();
    let names: Vec<String> = model.parameter_names().into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        names.join(" "),
        "A1[q1] A1[q1^2] A2[q1] A2[q1^2] a1,1 a1,2 a2,1 a2,2 tilt_x tilt_y twist base_x base_y base_z"
    );
    let mut theta = vec![0.0; model.parameters().len()];
    theta[..8].copy_from_slice(&[2.0, 0.5, -1.0, 0.25, 0.3, -0.2, 0.7, 0.1]);
    let model = model.with_parameters(&theta);
    let (a1, a2) = (2.0 * 0.4 + 0.5 * 0.16, -0.4 + 0.25 * 0.16);
    let expected = [a1, a1 * 0.3, a1 * -0.2, a2, a2 * 0.7, a2 * 0.1];
    for (found, expected) in model.strain_coordinates(&[0.4]).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15);
    }
}

#[test]
fn the_paper_has_twenty_parameters() {
    let paper = ArmSpec {
        registration: RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0; 3] },
        ..ArmSpec::default()
    };
    let model = StrainModel::new(&paper, 2, &[1.0]).unwrap();
    assert_eq!(model.actuation_range().len() + model.strain_range().len(), 20);
}

#[test]
fn stored_models_come_back_to_the_bit_and_damaged_ones_are_refused() {
    let model = StrainModel::new(&arm(StrainBasis::Piecewise { segments: 2 }, Axis::MinusY), 2, &[0.5, 1.0]).unwrap();
    let model = model.clone().with_parameters(&plausible(&model, 0.1));
    let text = serde_json::to_string(&model).unwrap();
    let read: StrainModel = serde_json::from_str(&text).unwrap();
    assert_eq!(read.parameters(), model.parameters());
    assert_eq!(read.arm(), model.arm());
    let refused = |from: &str, to: &str| {
        let damaged = text.replace(from, to);
        assert_ne!(damaged, text);
        serde_json::from_str::<StrainModel>(&damaged).unwrap_err().to_string()
    };
    assert!(refused("\"actuators\":2", "\"actuators\":3").contains("calibrate again"));
    assert!(refused("\"at\":[0.5,1.0]", "\"at\":[0.5,1.5]").contains("marker 2 is at s/L = 1.5"));
    assert!(refused("\"length\":0.5", "\"length\":-0.5").contains("positive length"));
}
