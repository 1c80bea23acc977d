//! Class 4: times from the sampling step to a third of a trial, whatever the unit of the plant is.

use crate::closed::{Closed, close};
use crate::motion::{Motion, Random, clock, lag, oscillator};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.01;

/// Six trials of `count` samples; the plant follows the motion.
fn closed(seed: u64, step: f64, periods: [f64; 2], plant: impl Fn(&[f64], &Motion) -> Vec<f64>) -> Closed {
    let time = clock(400, step);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(seed + k as u64);
        let q = Motion::new(&mut random, 1.0, 4, periods);
        let y = noisy(&mut random, NOISE, plant(&time, &q));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(4, 2).map(trial).collect();
    close(&Rig::one_to_one("V", "m", trials), &[])
}

/// An oven: a time constant of two minutes, a sample every 3 s.
#[test]
fn a_lag_of_two_minutes_has_its_time() {
    let closed = closed(51, 3.0, [700.0, 60.0], |time, q| lag(time, 120.0, |t| q.at(t)));
    assert!(closed.has(&["actuator_lag"]), "{closed}");
    assert!(closed.parameter("actuator_lag", "tau").is_within(0.05, 120.0), "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}

/// A ship that rolls: a resonance of a minute, a sample every 2 s.
#[test]
fn a_resonance_of_a_minute_has_its_period() {
    let (period, damping) = (60.0, 0.15);
    let closed = closed(61, 2.0, [600.0, 50.0], |time, q| oscillator(time, period, damping, |t| q.at(t)));
    assert!(closed.has(&["second_order_lag"]), "{closed}");
    assert!(closed.parameter("second_order_lag", "period").is_within(0.03, period), "{closed}");
    assert!(closed.after() < 1.2 * NOISE, "{closed}");
}

/// A structure that rings: a resonance of 10 ms, a sample every 0.4 ms.
#[test]
fn a_resonance_of_ten_milliseconds_has_its_period() {
    let (period, damping) = (0.010, 0.15);
    let closed = closed(71, 4e-4, [0.1, 0.008], |time, q| oscillator(time, period, damping, |t| q.at(t)));
    assert!(closed.has(&["second_order_lag"]), "{closed}");
    assert!(closed.parameter("second_order_lag", "period").is_within(0.03, period), "{closed}");
    assert!(closed.after() < 1.2 * NOISE, "{closed}");
}
