//! Class 2: several effects on one signal.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

/// Standard deviation of the torque's noise, N·m.
const NOISE: f64 = 0.02;

/// J, b, c of τ = 3 q + J q̈ + b q̇ + c tanh(q̇/v), v = 0.02 rad/s.
const TRUTH: [f64; 3] = [0.1, 0.5, 0.6];

/// Torque of a joint whose load is a spring, N·m.
fn torque(q: &Motion, t: f64) -> f64 {
    let [inertia, viscous, coulomb] = TRUTH;
    let friction = viscous * q.speed(t) + coulomb * (q.speed(t) / 0.02).tanh();
    3.0 * q.at(t) + inertia * q.acceleration(t) + friction
}

/// The commonest model in robotics: inertia, viscous and Coulomb friction of one joint.
#[test]
fn a_joint_has_inertia_and_both_frictions() {
    let time = clock(400, 0.02);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(31 + k as u64);
        let q = Motion::new(&mut random, 0.8, 4, [6.0, 1.5]);
        let y = noisy(&mut random, NOISE, time.iter().map(|t| torque(&q, *t)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(5, 2).map(trial).collect();
    let closed = close(&Rig::one_to_one("rad", "N*m", trials), &[]);
    // On a linear map a trail of the actuator is viscous friction: 3 (q + s q̇) = 3 q + 3 s q̇.
    let damping = match closed.has(&["viscous_slip"]) {
        true => -3.0 * closed.parameter("viscous_slip", "trail").value,
        false => closed.parameter("viscous_friction", "damping").value,
    };
    let [inertia, friction] = [("inertia", "mass"), ("coulomb_friction", "friction")]
        .map(|(effect, parameter)| closed.parameter(effect, parameter).value);
    let found = [inertia, damping, friction];
    for (found, truth) in found.into_iter().zip(TRUTH) {
        assert!((found / truth - 1.0).abs() < 0.1, "{found} for {truth}: {closed}");
    }
    // A reversal falls between two samples.
    assert!(closed.after() < 1.5 * NOISE, "{closed}");
}
