//! Class 2: several effects on one signal.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

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
        let q = Motion::new(&mut random, 0.8, 4, [4.0, 0.8]);
        let y = noisy(&mut random, NOISE, time.iter().map(|t| torque(&q, *t)));
        Trial::new(part, k, &time, vec![time.iter().map(|t| q.at(*t)).collect(), y])
    };
    let trials = (0..5).map(|k| ('d', k)).chain((5..7).map(|k| ('h', k))).map(trial).collect();
    let closed = close(&Rig::one_to_one("rad", "N*m", trials), &[]);
    for (effect, parameter, truth) in
        [("inertia", "mass", TRUTH[0]), ("viscous_friction", "damping", TRUTH[1]), ("coulomb_friction", "friction", TRUTH[2])]
    {
        assert!(closed.has(&[effect]), "no {effect}: {closed}");
        assert!(closed.parameter(effect, parameter).is_within(0.1, truth), "{effect}: {closed}");
    }
    // A reversal falls between two samples.
    assert!(closed.after() < 1.5 * NOISE, "{closed}");
}
