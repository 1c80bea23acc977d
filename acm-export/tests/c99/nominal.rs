//! Every nominal model: arms of all bases and axes, polynomials, static maps, predictions that come with the sample.

use acm_core::NominalModel;
use acm_core::augmented::AugmentedModel;
use acm_core::axis::Axis;
use acm_core::polynomial::Polynomial;
use acm_core::static_map::{Harmonic, Kink, StaticMap};
use acm_core::strain::StrainBasis;
use acm_export::c99;
use acm_stream::{Nominal, StateRule};
use nalgebra::DMatrix;

use crate::compile::{assert_equal, origin};
use crate::robots::{arm, parts, rig, small, term};
use acm_core::effects::Carrier;

fn polynomial(outputs: usize, degree: usize) -> Polynomial {
    let q = DMatrix::from_fn(90, 2, |t, a| ((0.7 * (a + 1) as f64) * t as f64).sin());
    let y = DMatrix::from_fn(90, outputs, |t, o| (q[(t, 0)] * (1.0 + o as f64) + q[(t, 1)]).sin());
    Polynomial::fit(&q, &y, degree).polynomial
}

#[test]
fn arms_of_every_basis_and_axis() {
    let legendre = |order| StrainBasis::Legendre { order };
    let piecewise = |segments| StrainBasis::Piecewise { segments };
    let bases = [legendre(0), legendre(1), legendre(3), piecewise(1), piecewise(4)];
    for (k, basis) in bases.into_iter().enumerate() {
        let model = NominalModel::Strain(arm(basis, Axis::ALL[k], &[1.0, 0.3]));
        assert_equal(&format!("{basis:?}"), &parts(small(), Nominal::Model(model), StateRule::Running), 10_000);
    }
}

/// A step of constant strain turns by up to nine radians, beyond where series hold.
#[test]
fn an_arm_that_is_rolled_up() {
    let model = arm(StrainBasis::Legendre { order: 0 }, Axis::Y, &[1.0]);
    let theta: Vec<f64> = model.parameters().iter().map(|value| 40.0 * value).collect();
    let model = NominalModel::Strain(model.with_parameters(&theta));
    assert_equal("rolled up", &parts(small(), Nominal::Model(model), StateRule::Running), 2000);
}

#[test]
fn polynomials_and_predictions_that_come_along() {
    let models = [Nominal::Model(NominalModel::Polynomial(polynomial(3, 3))), Nominal::Given(4)];
    for model in models {
        assert_equal("no arm", &parts(small(), model, StateRule::Running), 2000);
    }
}

#[test]
fn static_maps_and_models_of_a_prediction() {
    let powers = vec![vec![0, 0], vec![1, 0], vec![1, 2], vec![0, 3]];
    let coefficients = DMatrix::from_fn(4, 6, |j, o| 0.01 * (1.0 + (j * 6 + o) as f64).sin());
    let map = StaticMap::from_powers(vec![-0.3, -0.4], vec![0.4, 0.5], &powers, &coefficients);
    let base = NominalModel::Polynomial(polynomial(6, 2));
    let effects = vec![term("backlash", Carrier::Rig, &rig())];
    let kink = |actuator, at| Kink { actuator, at, slopes: (0..6).map(|o| 0.03 * f64::from(o) - 0.05).collect() };
    let bent = map.clone().with_kinks(vec![kink(0, 0.1), kink(1, -0.2)]);
    let sizes = |phase: f64| (0..6).map(|o| 0.02 * (f64::from(o) + phase).sin()).collect();
    let harmonic =
        |multiples: [i8; 2]| Harmonic { multiples: multiples.to_vec(), cosine: sizes(0.3), sine: sizes(1.9) };
    let turned = map.clone().with_harmonics(vec![harmonic([1, 0]), harmonic([1, -1])]);
    for (stands_for, map) in [(None, &map), (Some(polynomial(6, 1)), &map), (None, &bent), (None, &turned)] {
        let model = AugmentedModel::new(rig(), base.clone(), stands_for, Some(map.clone()), effects.clone());
        let parts = parts(small(), Nominal::Augmented(model.expect("a model")), StateRule::Running);
        assert_equal("static map", &parts, 2000);
    }
}

/// Samples ask for one, two and more doublings of few steps.
#[test]
fn an_arm_that_refines_its_steps_does_so_in_c() {
    for (tolerance, steps) in [(1e-4, 1), (1e-7, 1), (1e-9, 2)] {
        let fixed = arm(StrainBasis::Legendre { order: 2 }, Axis::Z, &[1.0, 0.4]);
        let spec = acm_core::ArmSpec { tolerance: Some(tolerance), steps, ..fixed.arm().clone() };
        let model =
            acm_core::StrainModel::new(&spec, 2, &[1.0, 0.4]).expect("an arm").with_parameters(fixed.parameters());
        let parts = parts(small(), Nominal::Model(NominalModel::Strain(model)), StateRule::Running);
        assert_equal(&format!("within {tolerance} m"), &parts, 3000);
        let source = c99::export(&parts, &origin()).expect("it can be written").pop().expect("a source").bytes;
        let text = String::from_utf8(source).expect("text");
        assert!(text.contains("#define LEVELS") && text.contains("&ARM_2_GRID"), "{tolerance}");
    }
}
