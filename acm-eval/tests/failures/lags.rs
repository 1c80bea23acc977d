//! Class 3: the static map is fitted again with each candidate.

use crate::closed::close;
use crate::motion::{Motion, Random, clock, lag};
use crate::rig::{Rig, Trial, noisy, parts};

const TAU: f64 = 3.0;
const NOISE: f64 = 0.005;

/// y = x + x³/5, 3 ẋ = q − x: a cubic in q at the same moment is flatter than the cubic in x.
#[test]
fn a_slow_lag_behind_a_static_map_is_found_with_its_time() {
    let time = clock(400, 0.1);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(41 + k as u64);
        let q = Motion::new(&mut random, 1.0, 4, [30.0, 3.0]);
        let x = lag(&time, TAU, |t| q.at(t));
        let y = noisy(&mut random, NOISE, x.iter().map(|x| x + 0.2 * x.powi(3)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(4, 2).map(trial).collect();
    let closed = close(&Rig::one_to_one("V", "m", trials), &[]);
    assert!(closed.has(&["actuator_lag"]), "{closed}");
    assert!(closed.parameter("actuator_lag", "tau").is_within(0.05, TAU), "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}
