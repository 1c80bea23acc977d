//! Class 1: the model that is handed out is the one that was scored, and no baseline runs away.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const LENGTH: f64 = 0.4;
const NOISE: f64 = 1e-3;

/// Tip of an arm that hangs along −y and bends with constant curvature by the angle (a, b).
fn tip(a: f64, b: f64) -> [f64; 3] {
    let angle = a.hypot(b).max(1e-9);
    let aside = LENGTH * (1.0 - angle.cos()) / (angle * angle);
    [aside * a, -LENGTH * angle.sin() / angle, aside * b]
}

/// A delay of 0.45 s. Two records for development, one held out; no calibration trials.
fn arm(seed: u64, delay: f64) -> Rig {
    let time = clock(1200, 0.05);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(seed + k as u64);
        let motions: [Motion; 2] = std::array::from_fn(|_| Motion::new(&mut random, 0.4, 4, [9.0, 2.0]));
        let bend = |t: f64| 1.6 * motions[0].at(t - delay);
        let turn = |t: f64| 1.4 * motions[1].at(t - delay);
        let at: Vec<[f64; 3]> = time.iter().map(|t| tip(bend(*t), turn(*t))).collect();
        let mut columns: Vec<Vec<f64>> = motions.iter().map(|q| q.sampled(&time)).collect();
        columns.extend((0..3).map(|i| noisy(&mut random, NOISE, at.iter().map(|p| p[i]))));
        Trial::new(part, k, &time, columns)
    };
    Rig {
        actuators: vec![["q1", "rad"], ["q2", "rad"]],
        contexts: vec![],
        outputs: vec![["x", "m"], ["y", "m"], ["z", "m"]],
        more: "[arm]\nlength = { value = 0.4, unit = \"m\" }\naxis = \"-y\"\nstrain = { basis = \"legendre\", order = 1 }\n"
            .into(),
        trials: [('d', 0), ('d', 1), ('h', 2)].map(trial).into(),
    }
}

/// Oracle: constant curvature is a strain model of order 0, so the noise of three axes is all that has to be left.
#[test]
fn a_late_arm_keeps_its_strain_model() {
    for seed in [1, 11, 21] {
        let closed = close(&arm(seed, 0.45), &[]);
        // The held-out record bends a little farther than the two others.
        assert!(closed.after() < 1.5 * NOISE * 3f64.sqrt(), "{closed}");
        assert!(closed.baseline("recalibrated") < 1.1 * closed.nominal(), "{closed}");
        assert_eq!(closed.names(), ["dead_time"], "{closed}");
        assert!(closed.parameter("dead_time", "delay").is_within(0.02, 0.45), "{closed}");
    }
}

/// Late while it was developed, punctual in its held-out trials: the delay harms there.
#[test]
fn what_harms_held_out_trials_is_not_handed_out() {
    let trial = |(part, k, delay): (char, usize, f64)| {
        let (time, mut random) = (clock(400, 0.05), Random::new(21 + k as u64));
        let q = Motion::new(&mut random, 0.8, 3, [8.0, 1.2]);
        let y = noisy(&mut random, 1e-3, time.iter().map(|t| 0.1 * q.at(t - delay)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let late = (0..4).map(|k| ('d', k, 0.3));
    let punctual = (4..6).map(|k| ('h', k, 0.0));
    let closed = close(&Rig::one_to_one("rad", "m", late.chain(punctual).map(trial).collect()), &[]);
    assert!(closed.has(&["dead_time"]) && closed.after() > 2.0 * closed.best_baseline(), "{closed}");
    assert!(!closed.has_model, "{closed}");
}
