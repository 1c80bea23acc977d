//! Class 10: inertia and friction from quantised angles at jittered instants.

use crate::closed::{Closed, close};
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const INERTIA: f64 = 0.1;
const FRICTION: f64 = 0.3;
const NOISE: f64 = 0.02;

/// Trials of τ = 3 q + what else the joint has, with an encoder of 4096 counts a turn, instants off by up to 3 of 10 ms.
fn closed(seed: u64, beside: impl Fn(&Motion, f64) -> f64) -> Closed {
    let count = std::f64::consts::TAU / 4096.0;
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(seed + k as u64);
        let time: Vec<f64> = clock(800, 0.01).into_iter().map(|t| t + 0.003 * random.uniform()).collect();
        let q = Motion::new(&mut random, 0.8, 4, [4.0, 0.8]);
        let y = noisy(&mut random, NOISE, time.iter().map(|t| 3.0 * q.at(*t) + beside(&q, *t)));
        Trial::new(part, k, &time, vec![time.iter().map(|t| count * (q.at(*t) / count).round()).collect(), y])
    };
    close(&Rig::one_to_one("rad", "N*m", parts(4, 2).map(trial).collect()), &[])
}

/// 0.1 q̈.
#[test]
fn a_joint_with_a_coarse_encoder_and_jittered_instants_has_its_inertia() {
    let closed = closed(131, |q, t| INERTIA * q.acceleration(t));
    assert!(closed.after() < 2.5 * NOISE, "{closed}");
    assert!(closed.parameter("inertia", "mass").is_within(0.05, INERTIA), "{closed}");
    assert_eq!(closed.names(), ["inertia"], "{closed}");
}

/// 0.3 sign q̇.
#[test]
fn a_joint_with_a_coarse_encoder_and_jittered_instants_has_its_friction() {
    let closed = closed(231, |q, t| FRICTION * q.speed(t).signum());
    assert!(closed.has(&["coulomb_friction"]), "{closed}");
    assert!(closed.parameter("coulomb_friction", "friction").is_within(0.1, FRICTION), "{closed}");
    assert!(closed.after() < 2.5 * NOISE, "{closed}");
}
