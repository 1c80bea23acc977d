//! Class 3: the static map is fitted again with each candidate.

use crate::closed::{Closed, close};
use crate::motion::{Motion, Random, clock, lag, oscillator};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.005;

/// y = x + a x³, τ ẋ = q − x.
fn closed(seed: u64, [tau, a]: [f64; 2], size: f64, periods: [f64; 2]) -> Closed {
    let time = clock(400, 0.1);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(seed + k as u64);
        let q = Motion::new(&mut random, size, 4, periods);
        let x = lag(&time, tau, |t| q.at(t));
        let y = noisy(&mut random, NOISE, x.iter().map(|x| x + a * x.powi(3)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    close(&Rig::one_to_one("V", "m", parts(4, 2).map(trial).collect()), &[])
}

/// A cubic in q at the same moment is flatter than the cubic in x.
#[test]
fn a_slow_lag_behind_a_static_map_is_found_with_its_time() {
    let closed = closed(41, [3.0, 0.2], 1.0, [30.0, 3.0]);
    assert!(closed.has(&["actuator_lag"]), "{closed}");
    assert!(closed.parameter("actuator_lag", "tau").is_within(0.05, 3.0), "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}

/// Motion is faster than the lag: the cubic in q is next to flat, and the lag moves the outputs by many times what there is to
/// explain.
#[test]
fn a_lag_slower_than_the_motion_is_found_with_its_time() {
    for seed in [241, 341] {
        let closed = closed(seed, [6.0, 0.5], 1.5, [12.0, 1.5]);
        assert!(closed.has(&["actuator_lag"]), "{seed}: {closed}");
        assert!(closed.parameter("actuator_lag", "tau").is_within(0.05, 6.0), "{seed}: {closed}");
        assert!(closed.after() < 1.5 * NOISE, "{seed}: {closed}");
    }
}

/// An oscillator behind the same map.
#[test]
fn an_oscillator_behind_a_static_map_is_found_with_its_period() {
    let (period, damping) = (2.5, 0.4);
    let time = clock(400, 0.1);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(441 + k as u64);
        let q = Motion::new(&mut random, 1.0, 4, [20.0, 5.0]);
        let x = oscillator(&time, period, damping, |t| q.at(t));
        let y = noisy(&mut random, NOISE, x.iter().map(|x| x + 0.2 * x.powi(3)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let closed = close(&Rig::one_to_one("V", "m", parts(4, 2).map(trial).collect()), &[]);
    assert!(closed.has(&["second_order_lag"]), "{closed}");
    assert!(closed.parameter("second_order_lag", "period").is_within(0.03, period), "{closed}");
    assert!(closed.after() < 1.5 * NOISE, "{closed}");
}
