//! Which effects a campaign can tell apart, on arms of two actuators whose excitation is chosen for what it can show.

use std::time::Instant;

use acm_core::arm::ArmSpec;
use acm_core::effects::Record;
use acm_core::nominal::{NominalModel, NominalSpec};
use acm_core::registration::RegistrationSpec;
use acm_core::rig::{Mounting, Rig, Signal};
use acm_core::tip_model::StrainModel;
use acm_trace::case::{Case, Trial};
use acm_trace::close::About;
use acm_trace::finding::{Data, Separability};
use acm_trace::separability::separability;
use acm_trace::trace::Options;
use nalgebra::{DMatrix, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// How a campaign moves.
#[derive(Debug, Clone)]
struct Design {
    /// Speeds of the first actuator, one for each trial in turn, 1/s.
    speeds: Vec<f64>,
    /// Whether the throttle steps within each trial, or only differs between trials.
    throttle_steps: bool,
    /// Whether trials of their own calibrate.
    calibration: bool,
    /// Whether the calibration finds the pose of the base.
    finds_base: bool,
    trials: usize,
    samples: usize,
}

const ONE_SPEED: Design =
    Design { speeds: Vec::new(), throttle_steps: false, calibration: true, finds_base: false, trials: 6, samples: 240 };

fn three_speeds() -> Design {
    Design { speeds: vec![0.1, 0.4, 1.6], ..ONE_SPEED }
}

const KNOWN: RegistrationSpec = RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0; 3] };

const STEP: f64 = 0.1;

/// Up and down between −0.8 and 0.8 at one speed.
fn reciprocating(time: f64, speed: f64) -> f64 {
    let phase = (time * speed / 3.2).fract();
    0.8 - 3.2 * (phase - 0.5).abs()
}

fn record(design: &Design, k: usize) -> Record {
    let speed = design.speeds.get(k % design.speeds.len().max(1)).copied().unwrap_or(0.4);
    let time: Vec<f64> = (0..design.samples).map(|t| STEP * t as f64).collect();
    let first = time.iter().map(|&t| reciprocating(t + 0.37 * k as f64, speed)).collect();
    let second = vec![0.5 * (k / 3 % 3) as f64 - 0.5; time.len()];
    let level = 0.4 + 0.1 * (k % 4) as f64;
    let step = |t: f64| if (t / 3.0) as usize % 2 == 0 { 0.1 } else { 0.9 };
    let throttle = |t: &f64| if design.throttle_steps { step(*t) } else { level };
    let throttle = time.iter().map(throttle).collect();
    let altitude = vec![0.5 + 0.4 * (k % 5) as f64; time.len()];
    Record::new(time, vec![first, second], vec![throttle, altitude], vec![])
}

/// Poses one after the other, all over the range.
fn poses(samples: usize, seed: u64) -> Record {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let time: Vec<f64> = (0..samples).map(|t| STEP * t as f64).collect();
    let mut draw = || (0..samples).map(|_| random.random_range(-1.0..1.0)).collect::<Vec<f64>>();
    let actuators = vec![draw(), draw()];
    Record::new(time, actuators, vec![vec![0.5; samples], vec![1.0; samples]], vec![])
}

fn arm(design: &Design) -> ArmSpec {
    let registration = if design.finds_base { RegistrationSpec::Identified { twist: true } } else { KNOWN };
    ArmSpec { degree: 1, registration, ..ArmSpec::default() }
}

fn truth(design: &Design) -> NominalModel {
    let model = StrainModel::new(&arm(design), 2, &[1.0]).unwrap();
    let mut theta = model.parameters().to_vec();
    // A1 and A2 in rad/m over q1, q2; then a1, a2.
    theta[..6].copy_from_slice(&[0.1, 0.9, 1.2, -0.1, -0.5, 0.4]);
    NominalModel::Strain(model.with_parameters(&theta))
}

fn trial(name: String, record: Record, truth: &NominalModel, seed: u64) -> Trial {
    let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
    let q = DMatrix::from_fn(record.samples(), 2, |t, a| record.actuators[a][t]);
    let noise = |random: &mut ChaCha8Rng| 1e-3 * (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
    let measured = truth.predict(&q).map(|p| p + noise(&mut random));
    Trial { name, record, lead: None, measured, predicted: None, offset: None }
}

fn signal(name: &str, unit: &str, values: impl Iterator<Item = f64>) -> Signal {
    let (low, high) = values.fold((f64::INFINITY, -f64::INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    Signal { name: name.into(), unit: unit.into(), low, high }
}

fn case(design: &Design) -> Case {
    let truth = truth(design);
    let development: Vec<Trial> =
        (0..design.trials).map(|k| trial(format!("d{k}"), record(design, k), &truth, k as u64)).collect();
    let calibration: Vec<Trial> = (0..if design.calibration { 3 } else { 0 })
        .map(|k| trial(format!("c{k}"), poses(100, k), &truth, 50 + k))
        .collect();
    let all = || calibration.iter().chain(&development);
    let actuator = |a: usize| all().flat_map(move |trial| trial.record.actuators[a].clone());
    let context = |e: usize| all().flat_map(move |trial| trial.record.contexts[e].clone());
    let output = |o: usize| all().flat_map(move |trial| trial.measured.column(o).iter().copied().collect::<Vec<f64>>());
    let rig = Rig {
        actuators: vec![signal("q1", "rad", actuator(0)), signal("q2", "rad", actuator(1))],
        contexts: vec![signal("throttle", "1", context(0)), signal("altitude", "m", context(1))],
        outputs: (0..3).map(|o| signal(["x", "y", "z"][o], "m", output(o))).collect(),
        throttle: Some(0),
        altitude: Some(1),
        payload: None,
        carried: false,
        arm: Some(Mounting { length: 0.62, down: -Vector3::z() }),
        step: STEP,
        duration: STEP * design.samples as f64,
    };
    let nominal = NominalSpec::Strain(arm(design));
    Case { rig, nominal, at: vec![1.0], reported: 0..3, calibration, development }
}

fn about() -> About {
    let data = Data {
        name: "arm".into(),
        title: "An arm of two actuators".into(),
        hash: "00".into(),
        synthetic: true,
        calibration: vec![],
        development: vec![],
        held_out: vec![],
    };
    About { data, configuration: serde_json::Value::Null, version: "0".into(), cautions: vec![], clock_interval: 0.0 }
}

fn judged(design: &Design, only: &[&str]) -> Separability {
    let only: Vec<String> = only.iter().map(ToString::to_string).collect();
    let only = (!only.is_empty()).then_some(only);
    separability(case(design), about(), &Options { only, ..Options::default() }).unwrap()
}

fn imitated(separability: &Separability, a: &str, b: &str) -> f64 {
    let index = |name: &str| {
        let is = |label: &String| label == name || label.starts_with(&format!("{name}("));
        separability.effects.iter().position(is).unwrap_or_else(|| panic!("no {name} in {:?}", separability.effects))
    };
    separability.imitated[index(a)][index(b)]
}

fn together(separability: &Separability, a: &str, b: &str) -> bool {
    let holds = |names: &[String], name: &str| names.iter().any(|label| label.split('(').next() == Some(name));
    separability.groups.iter().any(|group| holds(&group.effects, a) && holds(&group.effects, b))
}

/// q̃ of a play of half-width `width`, and of a lag `tau` on a signal that is straight between samples: written for
/// this test, in the plainest way.
fn play(q: &[f64], width: f64) -> Vec<f64> {
    let mut followed = vec![q[0]];
    for &q in &q[1..] {
        followed.push(followed[followed.len() - 1].clamp(q - width, q + width));
    }
    followed
}

fn lag(q: &[f64], tau: f64) -> Vec<f64> {
    let mut followed = vec![q[0]];
    for pair in q.windows(2) {
        let trail = tau * (pair[1] - pair[0]) / STEP;
        let behind = followed[followed.len() - 1] - pair[0] + trail;
        followed.push(pair[1] - trail + behind * (-STEP / tau).exp());
    }
    followed
}

/// Share of a play's mean square that the best lag imitates, for an output that is proportional to the actuator.
fn by_hand(design: &Design, width: f64) -> f64 {
    let trials: Vec<Vec<f64>> = (0..design.trials).map(|k| record(design, k).actuators[0].clone()).collect();
    let left = |tau: f64| -> f64 {
        let of = |q: &Vec<f64>| play(q, width).iter().zip(lag(q, tau)).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        trials.iter().map(of).sum()
    };
    let whole = left(1e-6);
    (1..600).map(|k| 1.0 - left(0.002 * f64::from(k)) / whole).fold(0.0, f64::max)
}

/// Oracle: a search by hand on the actuator alone; the tip of this arm is nearly proportional to it.
#[test]
fn play_and_lag_differ_with_speed_alone() {
    let names = ["backlash", "actuator_lag", "measurement_lag"];
    for (design, expected) in [(ONE_SPEED, 0.97..1.0), (three_speeds(), 0.4..0.65)] {
        let found = judged(&design, &names);
        let share = imitated(&found, "backlash", "actuator_lag");
        let oracle = by_hand(&design, 0.06);
        assert!((share - oracle).abs() < 0.04, "{share} where {oracle} is expected");
        assert!(expected.contains(&share), "{share}");
        assert!((share > 0.9) == together(&found, "backlash", "actuator_lag"), "{:?}", found.groups);
        // No excitation of the actuators tells a lag before the arm from one behind it.
        assert!(imitated(&found, "actuator_lag", "measurement_lag") > 0.97);
        assert!(imitated(&found, "measurement_lag", "actuator_lag") > 0.97);
        let group = found.groups.iter().find(|group| group.effects.contains(&"measurement_lag".to_string())).unwrap();
        assert!(group.effects.contains(&"actuator_lag".to_string()));
        assert!(group.experiment.contains("tap the tip"), "{}", group.experiment);
    }
}

#[test]
fn loads_look_alike_and_the_wake_needs_steps_of_the_throttle() {
    let names = ["tip_load", "self_weight", "downwash", "wake_lag"];
    let (still, steps) = (judged(&ONE_SPEED, &names), judged(&Design { throttle_steps: true, ..ONE_SPEED }, &names));
    for (a, b) in [("tip_load", "self_weight"), ("self_weight", "tip_load")] {
        assert!(imitated(&still, a, b) > 0.9 && imitated(&steps, a, b) > 0.9);
    }
    assert!(imitated(&still, "wake_lag", "downwash") > 0.999);
    assert!(together(&still, "downwash", "wake_lag"), "{:?}", still.groups);
    let wake = imitated(&steps, "wake_lag", "downwash");
    assert!(wake < 0.85, "{wake}");
    assert!(!together(&steps, "downwash", "wake_lag"), "{:?}", steps.groups);
}

#[test]
fn recalibration_takes_the_frame_where_it_finds_the_base_itself() {
    let names = ["misregistration", "backlash"];
    let free = Design { finds_base: true, calibration: false, ..three_speeds() };
    let (found, known) = (judged(&free, &names), judged(&three_speeds(), &names));
    let at = |separability: &Separability, name: &str| {
        let k = separability.effects.iter().position(|effect| effect == name).unwrap();
        separability.by_recalibration[k]
    };
    assert!(at(&found, "misregistration") > 0.9);
    assert!(at(&found, "backlash") < 0.3);
    assert!(at(&known, "misregistration") < 0.5, "calibration trials hold the frame");
    let group = found.groups.iter().find(|group| group.effects.contains(&"misregistration".to_string())).unwrap();
    assert!(group.experiment.contains("recalibration"), "{}", group.experiment);
}

/// And no number depends on the number of threads.
#[test]
fn every_effect_imitates_itself_and_all_shares_are_shares() {
    let design = Design { throttle_steps: true, trials: 17, samples: 500, ..three_speeds() };
    let begun = Instant::now();
    let found = judged(&design, &[]);
    println!("{} effects in {:.1} s", found.effects.len(), begun.elapsed().as_secs_f64());
    assert!(found.effects.len() >= 25 && found.effects.len() <= 40);
    assert_eq!((found.unit.as_str(), found.size), ("m", 0.01));
    assert_eq!(found.data.development.len(), 17);
    for (a, row) in found.imitated.iter().enumerate() {
        assert!(row[a] > 0.999, "{} imitates {} of itself", found.effects[a], row[a]);
        let least = found.by_recalibration[a];
        assert!(row.iter().all(|share| (least..=1.0).contains(share)), "{}: {row:?}", found.effects[a]);
    }
    let text = |names: &[&str], threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        serde_json::to_string(&pool.install(|| judged(&three_speeds(), names))).unwrap()
    };
    let names = ["backlash", "creep", "coulomb_friction", "tip_load"];
    assert_eq!(text(&names, 1), text(&names, 3));
}

/// Outputs that are no lengths, a model that is a polynomial, and no trials that calibrate.
#[test]
fn a_rig_without_an_arm_is_judged_by_the_spread_of_its_outputs() {
    let base = case(&three_speeds());
    let mut rig = Rig { arm: None, throttle: None, altitude: None, ..base.rig.clone() };
    rig.outputs.iter_mut().for_each(|output| output.unit = "N".into());
    let case = Case { rig, nominal: NominalSpec::Polynomial { degree: 1 }, at: vec![], calibration: vec![], ..base };
    let found = separability(case, about(), &Options::default()).unwrap();
    assert_eq!(found.unit, "N");
    assert!(found.size > 0.001 && found.size < 0.1, "a tenth of the spread: {}", found.size);
    let gain = found.effects.iter().position(|effect| effect == "static_gain").unwrap();
    assert!(found.by_recalibration[gain] > 0.99, "a polynomial that may move has any gain");
    assert!(found.groups.iter().any(|group| group.effects.contains(&"static_gain".to_string())));
    assert!((0..found.effects.len()).all(|k| found.imitated[k][k] > 0.999));
}

/// Oracle: shares have no unit, so outputs in thousandths of it leave them as they are, what recalibration takes over included.
#[test]
fn no_share_depends_on_the_unit_of_the_outputs() {
    let shares = |scale: f64| {
        let mut case = case(&three_speeds());
        case.rig = Rig { arm: None, throttle: None, altitude: None, ..case.rig };
        for output in &mut case.rig.outputs {
            *output = Signal { unit: "N".into(), low: scale * output.low, high: scale * output.high, ..output.clone() };
        }
        case.calibration.iter_mut().chain(&mut case.development).for_each(|trial| trial.measured *= scale);
        let case = Case { nominal: NominalSpec::Polynomial { degree: 1 }, at: vec![], ..case };
        let only = Some(["static_gain", "backlash", "actuator_lag"].map(String::from).into());
        separability(case, about(), &Options { only, ..Options::default() }).unwrap()
    };
    let (one, thousand) = (shares(1.0), shares(1000.0));
    assert_eq!(one.effects, thousand.effects);
    let all = |found: &Separability| [found.imitated.concat(), found.by_recalibration.clone()].concat();
    println!("{:?}\n{:?}", all(&one), all(&thousand));
    assert!(one.by_recalibration.iter().all(|share| *share > 1e-3), "calibration is known within limits: {one:?}");
    for (one, thousand) in all(&one).iter().zip(all(&thousand)) {
        assert!((one - thousand).abs() < 1e-4, "{one} and {thousand}");
    }
}
