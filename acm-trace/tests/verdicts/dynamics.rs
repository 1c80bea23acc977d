//! Rigs whose dynamics a straight lag does not have: dry friction in a pendulum, a coil that saturates in a field, servos that differ.

use acm_core::nominal::NominalSpec;
use acm_trace::case::Trial;
use acm_trace::finding::Finding;

use crate::bench::{Bench, STEP, effect, found, is_near, names, parameter, press, told};
use crate::effects::{charging, lagged, swinging};
use crate::motion::{Motion, random};

const NOISE: f64 = 0.01;

fn straight(actuators: usize, contexts: Vec<[&'static str; 2]>) -> Bench {
    Bench { actuators, nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![NOISE], ..press(contexts) }
}

/// Traces six trials, with two more held out.
fn traced(bench: &Bench, trial: impl Fn(&str, usize) -> Trial) -> Finding {
    let of = |part: &str, trials: std::ops::Range<usize>| trials.map(|k| trial(part, k)).collect();
    found(bench.case(vec![], of("d", 0..6), of("u", 6..8)))
}

/// A pendulum of 1.2 s whose bearing holds a twentieth of the largest torque.
#[test]
fn a_pendulum_swings_in_a_dry_bearing() {
    let bench = straight(1, vec![]);
    let pushed = |seed: f64| Motion::of(&[[0.2, 0.3, seed], [0.12, 0.78, 2.0 * seed], [0.1, 0.9, 0.4]]);
    let finding = traced(&bench, |name, k| {
        let mut drive = bench.drive(k, 400, 61, &[]);
        drive.motion = vec![pushed(k as f64)];
        let angle = drive.after(|time, motion| swinging(time, motion, [1.2, 0.04, 0.02]));
        bench.trial(name, &drive, &angle)
    });
    assert_eq!(names(&finding), ["coulomb_damping"], "{}", told(&finding));
    let [period, friction] = ["period", "friction"].map(|name| parameter(effect(&finding, "coulomb_damping"), name));
    assert!((period.value / 1.2 - 1.0).abs() < 0.02, "{period:?}");
    // In half ranges of the torque, the largest of the sums of its sines over all trials.
    let all = (0..6).flat_map(|k| (0..400).map(move |n| pushed(f64::from(k)).at(STEP * f64::from(n))));
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
    let truth = 0.02 / (0.5 * (high - low));
    assert!((friction.value / truth - 1.0).abs() < 0.1, "{friction:?} for {truth}");
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// A coil's current follows its voltage less 0.4 V for each rad/s of a recorded speed, after 0.7 s, and faster where its iron saturates.
#[test]
fn a_coil_moves_in_a_field() {
    let bench = straight(1, vec![["speed", "rad/s"]]);
    let finding = traced(&bench, |name, k| {
        let mut drive = bench.drive(k, 400, 62, &[0.0]);
        let speed = Motion::new(&mut random(620 + k as u64));
        drive.contexts[0] = drive.time.iter().map(|t| speed.at(*t)).collect();
        let current = charging(&drive.time, &drive.motion[0].with(-0.4, &speed), 0.7, 0.5);
        bench.trial(name, &drive, &[current])
    });
    assert_eq!(names(&finding), ["input_disturbance", "state_dependent_lag"], "{}", told(&finding));
    let worth = parameter(effect(&finding, "input_disturbance"), "worth_q1");
    assert!((worth.value / -0.4 - 1.0).abs() < 0.03, "{worth:?}");
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// A motor's speed follows the product of its duty and its supply, 24 V and 3 V about it, after 0.6 s.
#[test]
fn a_supply_sags() {
    let bench = straight(1, vec![["supply", "V"]]);
    let finding = traced(&bench, |name, k| {
        let mut drive = bench.drive(k, 400, 65, &[0.0]);
        let sag = Motion::new(&mut random(650 + k as u64));
        drive.contexts[0] = drive.time.iter().map(|t| 24.0 + 3.0 * sag.at(*t)).collect();
        let pushed = drive.motion[0].with(3.0 / 24.0, &drive.motion[0].times(&sag));
        let speed = lagged(&drive.time, &pushed, 0.6);
        bench.trial(name, &drive, &[speed])
    });
    assert_eq!(names(&finding), ["actuator_lag", "input_gain"], "{}", told(&finding));
    // Relative to the gain in the middle of the supply's range.
    let gain = parameter(effect(&finding, "input_gain"), "gain");
    assert!((gain.value * 24.0 - 1.0).abs() < 0.05, "{gain:?}");
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Three servos that follow after 0.2, 0.5 and 1.0 s.
#[test]
fn servos_differ() {
    let bench = straight(3, vec![]);
    let taus = [0.2, 0.5, 1.0];
    let finding = traced(&bench, |name, k| {
        let drive = bench.drive(k, 300, 63, &[]);
        let late: Vec<Vec<f64>> =
            drive.motion.iter().zip(taus).map(|(motion, tau)| lagged(&drive.time, motion, tau)).collect();
        let y = (0..300).map(|t| 2.0 * late[0][t] + 3.0 * late[1][t] - 2.0 * late[2][t]).collect();
        bench.trial(name, &drive, &[y])
    });
    assert_eq!(names(&finding), ["actuator_lag"; 3], "{}", told(&finding));
    for (name, truth) in ["q1", "q2", "q3"].into_iter().zip(taus) {
        let of = finding.effects.iter().find(|found| found.carrier.as_deref() == Some(name)).unwrap();
        let tau = parameter(of, "tau").value;
        assert!((tau / truth - 1.0).abs() < 0.05, "{name}: {tau}");
    }
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}
