//! Calibration: planted parameters come back, standard deviations mean what they say, and no bit depends on threads.

use acm_core::axis::Axis;
use acm_core::registration::RegistrationSpec;
use acm_core::strain::StrainBasis;
use acm_core::{
    ArmSpec, Calibration, CalibrationOptions, NominalModel, NominalSpec, Observations, StrainModel, calibrate,
    calibrate_with, completed,
};
use nalgebra::{DMatrix, Rotation3, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// The paper's robot, tilted by a few degrees and off the origin.
fn paper_arm() -> ArmSpec {
    ArmSpec::default()
}

fn paper_truth() -> StrainModel {
    let model = StrainModel::new(&paper_arm(), 2, &[1.0]).unwrap();
    let mut theta = model.parameters().to_vec();
    // A1 and A2 in rad/m over q1, q2, q1², q1 q2, q2², q1³, …; a1, a2; tilt, base.
    theta[..9].copy_from_slice(&[0.1, 0.9, 0.02, -0.05, 0.03, 0.0, 0.01, -0.02, 0.005]);
    theta[9..18].copy_from_slice(&[1.2, -0.1, 0.06, 0.04, -0.01, -0.03, 0.01, 0.0, 0.002]);
    theta[18..20].copy_from_slice(&[-0.6, 0.8]);
    theta[20..].copy_from_slice(&[0.06, -0.04, 0.0, 0.11, -0.03, 1.4]);
    model.with_parameters(&theta)
}

/// Three segments, six actuators, a marker at the end of each segment, the base turned well off the axis.
fn trunk_arm() -> ArmSpec {
    ArmSpec {
        length: 0.34,
        axis: Axis::MinusY,
        strain: StrainBasis::Piecewise { segments: 3 },
        degree: 1,
        ..ArmSpec::default()
    }
}

const TRUNK_MARKERS: [f64; 3] = [1.0 / 3.0, 2.0 / 3.0, 1.0];

fn trunk_truth(twist: f64) -> StrainModel {
    let model = StrainModel::new(&trunk_arm(), 6, &TRUNK_MARKERS).unwrap();
    let mut theta: Vec<f64> = (0..model.parameters().len()).map(|j| 2.0 * (1.0 + 2.3 * j as f64).sin()).collect();
    let start = model.registration_range().start;
    theta[start..].copy_from_slice(&[0.15, -0.25, twist, 0.3, 0.1, -0.2]);
    model.with_parameters(&theta)
}

/// Evenly drawn actuators in ±span, and the truth's markers with noise of `sd` m.
fn record(truth: &StrainModel, samples: usize, span: f64, sd: f64, seed: u64) -> Observations {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = |width: f64| width * random.random_range(-1.0..1.0f64);
    let actuators = DMatrix::from_fn(samples, truth.actuators(), |_, _| draw(span));
    let clean = NominalModel::Strain(truth.clone()).predict(&actuators);
    // The sum of twelve even draws is near enough to a normal one, and has unit variance.
    let measured = clean.map(|p| p + sd * (0..12).map(|_| draw(0.5)).sum::<f64>());
    Observations { actuators, measured, at: truth.at().to_vec() }
}

fn strain_of(calibration: &Calibration) -> &StrainModel {
    match &calibration.model {
        NominalModel::Strain(model) => model,
        other => panic!("not a strain model: {other:?}"),
    }
}

#[test]
fn the_papers_arm_gives_its_planted_parameters_back() {
    let truth = paper_truth();
    let data = record(&truth, 600, 2.5, 0.0, 3);
    let found = calibrate(&NominalSpec::Strain(paper_arm()), &data).unwrap();
    let names: Vec<&str> = found.stages.iter().map(|stage| stage.name.as_str()).collect();
    assert_eq!(names, ["actuation", "strain", "joint"]);
    assert!(found.stages[2].stopped.converged());
    assert!(found.rms_total < 1e-9, "{:e}", found.rms_total);
    assert_eq!(found.parameters.len(), 25);
    for (mine, planted) in strain_of(&found).parameters().iter().zip(truth.parameters()) {
        assert!((mine - planted).abs() < 1e-6, "{mine} {planted}");
    }
}

#[test]
fn noise_moves_the_parameters_by_their_standard_deviations() {
    let truth = paper_truth();
    let data = record(&truth, 1500, 2.5, 2e-3, 4);
    let found = calibrate(&NominalSpec::Strain(paper_arm()), &data).unwrap();
    let expected = 2e-3 * 3f64.sqrt();
    assert!((found.rms_total / expected - 1.0).abs() < 0.05, "{}", found.rms_total);
    let names = truth.parameter_names();
    for parameter in &found.parameters {
        let index = names.iter().position(|(name, _)| *name == parameter.name).unwrap();
        let sd = parameter.sd.unwrap();
        let off = (parameter.value - truth.parameters()[index]) / sd;
        assert!(off.abs() < 4.5, "{} is {off:.1} sd off", parameter.name);
    }
}

/// Oracle: the spread of estimates over repeated noise.
#[test]
fn standard_deviations_agree_with_repeated_noise() {
    let truth = paper_truth();
    let arm = ArmSpec { registration: RegistrationSpec::Identified { twist: false }, ..paper_arm() };
    let options = CalibrationOptions { starts: 1, ..CalibrationOptions::default() };
    let spec = NominalSpec::Strain(arm);
    let repeats = 60;
    let fits: Vec<Calibration> = (0..repeats)
        .map(|k| calibrate_with(&spec, &record(&truth, 150, 2.5, 1e-3, 100 + k), &options).unwrap())
        .collect();
    for j in 0..fits[0].parameters.len() {
        let values: Vec<f64> = fits.iter().map(|fit| fit.parameters[j].value).collect();
        let mean = values.iter().sum::<f64>() / repeats as f64;
        let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (repeats - 1) as f64).sqrt();
        let claimed = fits.iter().filter_map(|fit| fit.parameters[j].sd).sum::<f64>() / repeats as f64;
        // 60 repeats know a standard deviation to 9 %; four of those, and the actuators are redrawn each time.
        let name = &fits[0].parameters[j].name;
        assert!((spread / claimed - 1.0).abs() < 0.4, "{name}: {spread:e} against {claimed:e}");
    }
}

#[test]
fn a_trunk_of_three_segments_gives_its_planted_parameters_back() {
    let truth = trunk_truth(0.0);
    let data = record(&truth, 500, 1.0, 0.0, 5);
    let found = calibrate(&NominalSpec::Strain(trunk_arm()), &data).unwrap();
    assert!(found.rms_total < 1e-10, "{:e}", found.rms_total);
    assert_eq!(found.parameters.len(), 36 + 5);
    for (mine, planted) in strain_of(&found).parameters().iter().zip(truth.parameters()) {
        assert!((mine - planted).abs() < 1e-7, "{mine} {planted}");
    }
}

/// A base turned about the arm's axis cannot be distinguished from turned bending directions, and does not need to be.
#[test]
fn an_unknown_twist_of_the_base_is_carried_by_the_actuation_map() {
    let truth = trunk_truth(2.2);
    let data = record(&truth, 500, 1.0, 0.0, 6);
    let found = calibrate(&NominalSpec::Strain(trunk_arm()), &data).unwrap();
    let fresh = record(&truth, 100, 1.0, 0.0, 7);
    let error = found.model.predict(&fresh.actuators) - &fresh.measured;
    assert!(error.amax() < 1e-9, "{:e}", error.amax());
}

/// Oracle: the registration that was planted, here known and fixed.
#[test]
fn a_known_registration_is_used_and_not_fitted() {
    let truth = paper_truth();
    let registration = &truth.parameters()[20..];
    let local = Vector3::new(registration[0], registration[1], registration[2]);
    let rotation = Axis::MinusZ.rotation() * local;
    let arm = ArmSpec {
        registration: RegistrationSpec::Fixed {
            rotation: rotation.into(),
            translation: [registration[3], registration[4], registration[5]],
        },
        ..paper_arm()
    };
    let data = record(&truth, 300, 2.5, 0.0, 8);
    let found = calibrate(&NominalSpec::Strain(arm), &data).unwrap();
    assert_eq!(found.parameters.len(), 20);
    assert!(found.rms_total < 1e-9);
    let base = strain_of(&found).pose(&[0.0, 0.0], 0.0);
    let turned = Rotation3::new(rotation).into_inner();
    assert!((base.rotation - turned).amax() < 1e-14);
}

#[test]
fn no_bit_depends_on_the_number_of_threads() {
    let data = record(&paper_truth(), 900, 2.5, 1e-3, 9);
    let spec = NominalSpec::Strain(paper_arm());
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        serde_json::to_string(&pool.install(|| calibrate(&spec, &data).unwrap())).unwrap()
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn stored_calibrations_predict_the_same_bits() {
    let data = record(&paper_truth(), 200, 2.5, 1e-3, 10);
    let specs = [NominalSpec::Strain(paper_arm()), NominalSpec::Polynomial { degree: 3 }, NominalSpec::None];
    for spec in specs {
        let text = serde_json::to_string(&spec).unwrap();
        assert_eq!(serde_json::from_str::<NominalSpec>(&text).unwrap(), spec);
        let found = calibrate(&spec, &data).unwrap();
        let text = serde_json::to_string(&found).unwrap();
        let read: Calibration = serde_json::from_str(&text).unwrap();
        assert_eq!(read.model.predict(&data.actuators), found.model.predict(&data.actuators));
        assert_eq!(read.parameters, found.parameters);
        assert_eq!(found.model.outputs(), 3);
    }
}

/// Oracle: thirty coefficients, and errors recomputed from the prediction.
#[test]
fn the_comparator_reports_its_own_errors() {
    let data = record(&paper_truth(), 400, 2.5, 1e-3, 11);
    let found = calibrate(&NominalSpec::Polynomial { degree: 3 }, &data).unwrap();
    assert_eq!(found.parameters.len(), 30);
    let error = found.model.predict(&data.actuators) - &data.measured;
    let total: f64 = found.rms.iter().map(|rms| rms * rms).sum();
    let direct = error.iter().map(|e| e * e).sum::<f64>() / 400.0;
    assert!((total - direct).abs() < 1e-12 * direct);
    assert!((found.rms_total.powi(2) - direct).abs() < 1e-12 * direct);
    assert!(found.stages[0].stopped.converged());
}

#[test]
fn an_actuator_that_never_moves_is_no_trouble() {
    let mut data = record(&paper_truth(), 300, 2.5, 1e-3, 12);
    data.actuators.column_mut(1).fill(0.0);
    data.measured = NominalModel::Strain(paper_truth()).predict(&data.actuators);
    let found = calibrate(&NominalSpec::Strain(paper_arm()), &data).unwrap();
    assert!(found.rms_total < 1e-7, "{:e}", found.rms_total);
    let idle = found.parameters.iter().find(|p| p.name == "A1[q2]").unwrap();
    assert!(idle.value.abs() < 1e-12 && idle.sd.is_none(), "{idle:?}");
}

#[test]
fn every_refusal_says_what_to_do() {
    let good = record(&paper_truth(), 300, 2.5, 0.0, 13);
    let strain = NominalSpec::Strain(paper_arm());
    let message = |spec: &NominalSpec, change: &dyn Fn(&mut Observations)| {
        let mut data = good.clone();
        change(&mut data);
        calibrate(spec, &data).unwrap_err().to_string()
    };
    let text = message(&strain, &|d| d.measured[(41, 2)] = f64::NAN);
    assert!(text.contains("measured row 42, column 3 is NaN; drop the sample"), "{text}");
    let text = message(&strain, &|d| d.actuators[(0, 1)] = f64::INFINITY);
    assert!(text.contains("actuators row 1, column 2 is inf"), "{text}");
    let text = message(&strain, &|d| d.actuators[(2, 0)] = -1e200);
    assert!(text.contains("actuators row 3, column 1 is -1e200, beyond 1e15"), "{text}");
    let text = message(&strain, &|d| d.at = vec![0.0]);
    assert!(text.contains("marker 1 is at s/L = 0"), "{text}");
    let text = message(&strain, &|d| d.at = vec![0.5, 1.0]);
    assert!(text.contains("3 measured columns for 2 marker(s)") && text.contains("6 columns"), "{text}");
    let text = message(&strain, &|d| d.measured = d.measured.rows(0, 5).into_owned());
    assert!(text.contains("300 rows of actuators but 5 rows"), "{text}");
    let few = |d: &mut Observations| {
        d.actuators = d.actuators.rows(0, 8).into_owned();
        d.measured = d.measured.rows(0, 8).into_owned();
    };
    let text = message(&strain, &few);
    assert!(text.contains("8 samples cannot determine 25 parameters"), "{text}");
    let text = message(&NominalSpec::Polynomial { degree: 3 }, &few);
    assert!(text.contains("8 samples cannot determine 10 parameters"), "{text}");
    let text = message(&NominalSpec::Polynomial { degree: 0 }, &|_| ());
    assert!(text.contains("polynomial degree is 0; choose 1 to 9"), "{text}");
    let bad = NominalSpec::Strain(ArmSpec { length: -1.0, ..paper_arm() });
    assert!(message(&bad, &|_| ()).contains("arm length is -1 m"));
}

#[test]
fn specifications_read_as_the_manifest_writes_them() {
    let text = r#"{"model": "strain", "length": 0.34, "axis": "-y", "strain": {"basis": "piecewise", "segments": 3},
        "degree": 1, "registration": {"kind": "identified"}}"#;
    let spec: NominalSpec = serde_json::from_str(text).unwrap();
    assert_eq!(spec, NominalSpec::Strain(trunk_arm()));
    assert!(serde_json::from_str::<NominalSpec>(&text.replace("length", "lenght")).is_err());
    let cubic: NominalSpec = serde_json::from_str(r#"{"model": "polynomial"}"#).unwrap();
    assert_eq!(cubic, NominalSpec::Polynomial { degree: 3 });
}

/// Calibration at three values of q2, which leave the cubic in q2 open, and further trials between 0.4 and 2 that are off by `off` m.
fn open(truth: &StrainModel, off: f64) -> [Observations; 2] {
    let held = |low: &dyn Fn(usize) -> f64| {
        let all = record(truth, 600, 1.0, 0.0, 11);
        let actuators = DMatrix::from_fn(600, 2, |t, a| if a == 1 { low(t) } else { all.actuators[(t, a)] });
        let measured = NominalModel::Strain(truth.clone()).predict(&actuators);
        Observations { actuators, measured, at: all.at }
    };
    let calibration = held(&|t| 0.3 * (t % 3) as f64);
    let further = held(&|t| 0.4 + 1.6 * t as f64 / 599.0);
    [calibration, Observations { measured: further.measured.map(|p| p + off), ..further }]
}

/// Oracle: the truth. Beyond what it was calibrated on the model is far off; completed, by what the further trials are off at most; where it
/// was calibrated, a tenth of that is not reached.
#[test]
fn further_trials_decide_what_a_calibration_leaves_open() {
    let truth = paper_truth();
    let [calibration, further] = open(&truth, 0.02);
    let calibrated = strain_of(&calibrate(&NominalSpec::Strain(paper_arm()), &calibration).unwrap()).clone();
    let completed = completed(&calibrated, &calibration, &further, None);
    let error = |model: &StrainModel, at: &Observations| {
        let predicted = |model: &StrainModel| NominalModel::Strain(model.clone()).predict(&at.actuators);
        ((predicted(model) - predicted(&truth)).norm_squared() / at.samples() as f64).sqrt()
    };
    assert!(error(&calibrated, &further) > 0.1, "{}", error(&calibrated, &further));
    assert!(error(&completed, &further) < 0.04, "{}", error(&completed, &further));
    assert!(error(&completed, &calibration) < 0.002, "{}", error(&completed, &calibration));
}

/// Oracle: the truth, which is the other start. From strain that is curled up the fit ends elsewhere.
#[test]
fn a_completion_takes_the_better_of_two_starts() {
    let truth = paper_truth();
    let [calibration, further] = open(&truth, 0.0);
    let mut theta = truth.parameters().to_vec();
    theta[..18].iter_mut().for_each(|p| *p = 40.0 * *p + 9.0);
    let curled = truth.clone().with_parameters(&theta);
    let error = |other: Option<&StrainModel>| {
        let model = NominalModel::Strain(completed(&curled, &calibration, &further, other));
        (model.predict(&further.actuators) - &further.measured).norm() / (further.samples() as f64).sqrt()
    };
    let (alone, beside) = (error(None), error(Some(&truth)));
    assert!(alone > 0.05 && beside < 1e-6, "{alone} {beside}");
}
