//! Rigs of a laboratory: a sensor on a supply, motors, a pendulum, a slow plant of which one record is cut in two.

use acm_core::nominal::NominalSpec;
use acm_trace::finding::Level;

use crate::bench::{Bench, FORCE_NOISE, Recorded, STEP, effect, force, found, is_near, names, parameter, press, told};
use crate::effects::{lagged, sticking, swinging};
use crate::motion::{Motion, random, wandering};
use crate::rigs::part;

/// A press whose sensor has 4 % more gain for each volt of its supply.
#[test]
fn a_gain_follows_its_supply() {
    let bench = press(vec![["supply", "V"]]);
    let trial = |name: &str, k: usize| {
        let mut drive = bench.drive(k, 250, 41, &[0.0]);
        drive.contexts[0] = wandering(&mut random(410 + k as u64), 250, STEP, 1.0, 10.0);
        let y = drive.q()[0].iter().zip(&drive.contexts[0]).map(|(q, c)| force(*q) * (1.0 + 0.04 * c)).collect();
        bench.trial(name, &drive, &[y])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["context_gain"], "{}", told(&finding));
    let found = effect(&finding, "context_gain");
    assert_eq!(found.confidence.level, Level::Sure);
    // Relative to the gain at the middle of the recorded supply, which lies within 3 V of the mean.
    let gain = parameter(found, "gain").value;
    assert!((gain / 0.04 - 1.0).abs() < 0.15, "{gain}");
    assert!(is_near(&finding, FORCE_NOISE), "{}", told(&finding));
}

/// A press whose sensor drifts by 0.3 N for each kelvin of a recorded temperature, 6 s behind it.
#[test]
fn a_sensor_warms_up_behind_a_temperature() {
    let bench = press(vec![["temperature", "K"]]);
    let trial = |name: &str, k: usize| {
        let mut drive = bench.drive(k, 250, 47, &[0.0]);
        let temperature = Motion::new(&mut random(470 + k as u64));
        drive.contexts[0] = drive.time.iter().map(|t| 290.0 + 4.0 * temperature.at(*t)).collect();
        let late = lagged(&drive.time, &temperature, 6.0);
        let y = drive.q()[0].iter().zip(&late).map(|(q, late)| force(*q) + 0.3 * 4.0 * late).collect();
        bench.trial(name, &drive, &[y])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["context_lag"], "{}", told(&finding));
    let found = effect(&finding, "context_lag");
    for (name, truth) in [("tau", 6.0), ("sensitivity_force", 0.3)] {
        let found = parameter(found, name);
        assert!((found.value / truth - 1.0).abs() < 0.1, "{found:?}");
    }
    assert!(is_near(&finding, FORCE_NOISE), "{}", told(&finding));
}

/// The torque at the shoulder of three joints in a vertical plane, in N m: weights of 8, 5 and 3 N m turn with sums of their angles, as
/// far as 2.8 rad. Its joints lag by 0.4 s. A polynomial of three angles with few enough columns has the degree 4.
#[test]
fn weights_of_a_chain_turn_with_sums_of_angles() {
    let bench = Bench {
        actuators: 3,
        contexts: vec![],
        outputs: vec![["torque", "N*m"]],
        nominal: NominalSpec::Polynomial { degree: 3 },
        noise: vec![0.02],
    };
    let torque = |q: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let sums = |t: usize| [q[0][t], q[0][t] + q[1][t], q[0][t] + q[1][t] + q[2][t]];
        let at = |t: usize| sums(t).iter().zip([8.0, 5.0, 3.0]).map(|(angle, weight)| weight * angle.cos()).sum();
        vec![(0..q[0].len()).map(at).collect()]
    };
    let trial = |name: &str, k: usize| {
        let drive = bench.drive(k, 250, 48, &[]);
        bench.trial(name, &drive, &torque(&drive.after(|time, motion| lagged(time, motion, 0.4))))
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["actuator_lag"], "{}", told(&finding));
    let tau = parameter(effect(&finding, "actuator_lag"), "tau");
    assert!((tau.value / 0.4 - 1.0).abs() < 0.05, "{tau:?}");
    assert!(is_near(&finding, 0.02), "{}", told(&finding));
}

/// A motor's speed follows its voltage after 0.5 s; friction takes 0.12 V of ±0.95 V.
#[test]
fn a_motor_sticks() {
    let bench = Bench { nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![0.02], ..press(vec![]) };
    let trial = |name: &str, k: usize| {
        let drive = bench.drive(k, 300, 42, &[]);
        let speed = drive.after(|time, motion| sticking(time, motion, 0.5, 0.12)).swap_remove(0);
        bench.trial(name, &drive, &[speed.iter().map(|v| 4.0 * v).collect()])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["friction_lag"], "{}", told(&finding));
    let lag = effect(&finding, "friction_lag");
    for (name, truth) in [("tau", 0.5), ("friction_q1", 0.12)] {
        let found = parameter(lag, name);
        assert!((found.value / truth - 1.0).abs() < 0.05, "{found:?}");
    }
    assert!(is_near(&finding, 0.02), "{}", told(&finding));
}

/// A motor's speed follows its voltage after 0.5 s; a sensor shows it without its sign. No straight line of anything predicts that.
#[test]
fn a_sensor_shows_no_sign() {
    let bench = Bench { nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![0.02], ..press(vec![]) };
    let trial = |name: &str, k: usize| {
        let drive = bench.drive(k, 300, 46, &[]);
        let speed = drive.after(|time, motion| lagged(time, motion, 0.5)).swap_remove(0);
        bench.trial(name, &drive, &[speed.iter().map(|v| (4.0 * v).abs()).collect()])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["actuator_lag"], "{}", told(&finding));
    let tau = parameter(effect(&finding, "actuator_lag"), "tau");
    assert!((tau.value / 0.5 - 1.0).abs() < 0.05, "{tau:?}");
    assert!(finding.errors.after.value < 1.5 * 0.02, "{}", told(&finding));
}

/// Of three actuators one follows after 0.8 s, the others at once.
#[test]
fn one_actuator_lags_alone() {
    let bench =
        Bench { actuators: 3, nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![0.02], ..press(vec![]) };
    let trial = |name: &str, k: usize| {
        let drive = bench.drive(k, 250, 43, &[]);
        let (q, late) = (drive.q(), lagged(&drive.time, &drive.motion[1], 0.8));
        let y = (0..250).map(|t| 2.0 * q[0][t] + 3.0 * late[t] - q[2][t]).collect();
        bench.trial(name, &drive, &[y])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["actuator_lag"], "{}", told(&finding));
    let lag = effect(&finding, "actuator_lag");
    assert_eq!(lag.carrier.as_deref(), Some("q2"));
    let tau = parameter(lag, "tau");
    assert!((tau.value / 0.8 - 1.0).abs() < 0.05, "{tau:?}");
    assert!(is_near(&finding, 0.02), "{}", told(&finding));
}

/// A pendulum of 1.2 s with a damping of 0.05 swings out by several times what the torque holds at rest.
#[test]
fn a_pendulum_with_little_damping_is_fitted_to_the_noise() {
    let bench = Bench {
        outputs: vec![["angle", "rad"]],
        nominal: NominalSpec::Polynomial { degree: 1 },
        noise: vec![0.005],
        ..press(vec![])
    };
    let pushed =
        |seed: u64| Motion::of(&[[0.04, 0.3, seed as f64], [0.05, 0.81, 2.0 * seed as f64], [0.03, 0.88, 0.4]]);
    let trial = |name: &str, k: usize| {
        let mut drive = bench.drive(k, 400, 44, &[]);
        drive.motion = vec![pushed(k as u64)];
        let angle = drive.after(|time, motion| swinging(time, motion, [1.2, 0.05, 0.0])).swap_remove(0);
        bench.trial(name, &drive, &[angle])
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    let finding = found(case);
    assert_eq!(names(&finding), ["nonlinear_stiffness"], "{}", told(&finding));
    let [period, hardness] =
        ["period", "hardness"].map(|name| parameter(effect(&finding, "nonlinear_stiffness"), name).value);
    assert!((period / 1.2 - 1.0).abs() < 0.02 && hardness < 0.0, "{period} {hardness}");
    assert!(finding.errors.after.value < 0.008, "{}", told(&finding));
}

/// A plant that forgets in 15 s, so that its state at the cut is that of the inputs before it. Without them it has to be estimated from
/// the warm-up.
#[test]
fn a_cut_record_goes_on_where_it_was() {
    let bench = press(vec![]);
    let drive = bench.drive(0, 900, 45, &[]);
    let late = drive.after(|time, motion| lagged(time, motion, 15.0)).swap_remove(0);
    let whole = bench.trial("r", &drive, &[late.iter().map(|q| force(*q)).collect()]);
    let [first, last] = [part(&whole, "first", 0..600), part(&whole, "last", 600..900)];
    let led = acm_trace::case::Trial { lead: Some(first.record.clone()), ..last.clone() };
    let [alone, led] = [last, led].map(|last| {
        let Recorded { case, .. } = bench.case(vec![], vec![first.clone()], vec![]);
        found(Recorded { case, held_out: vec![last] })
    });
    assert_eq!(names(&led), ["actuator_lag"], "{}", told(&led));
    assert!(is_near(&led, FORCE_NOISE), "{}", told(&led));
    assert!(alone.errors.after.value > 1.3 * led.errors.after.value, "{} {}", told(&alone), told(&led));
}
