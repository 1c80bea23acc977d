//! Class 10: inertia from quantised angles at jittered instants.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const INERTIA: f64 = 0.1;
const NOISE: f64 = 0.02;

/// τ = 3 q + 0.1 q̈ with an encoder of 4096 counts a turn, instants off by up to 3 of 10 ms.
#[test]
fn a_joint_with_a_coarse_encoder_and_jittered_instants_has_its_inertia() {
    let count = std::f64::consts::TAU / 4096.0;
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(131 + k as u64);
        let time: Vec<f64> = clock(800, 0.01).into_iter().map(|t| t + 0.003 * random.uniform()).collect();
        let q = Motion::new(&mut random, 0.8, 4, [4.0, 0.8]);
        let torque = |t: f64| 3.0 * q.at(t) + INERTIA * q.acceleration(t);
        let y = noisy(&mut random, NOISE, time.iter().map(|t| torque(*t)));
        Trial::new(part, k, &time, vec![time.iter().map(|t| count * (q.at(*t) / count).round()).collect(), y])
    };
    let trials = parts(4, 2).map(trial).collect();
    let closed = close(&Rig::one_to_one("rad", "N*m", trials), &[]);
    assert!(closed.after() < 2.5 * NOISE, "{closed}");
    assert!(closed.parameter("inertia", "mass").is_within(0.05, INERTIA), "{closed}");
    assert_eq!(closed.names(), ["inertia"], "{closed}");
}
