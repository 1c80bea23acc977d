//! Class 13: no constant decides against significance.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.01;

/// A context that moves the output by 0.7 of its noise, beside a delay that moves it by some eighty times its noise.
#[test]
fn a_small_effect_beside_a_large_one_is_found() {
    let time = clock(600, 0.03);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(181 + k as u64);
        let [q, pressure] = [[9.0, 1.5], [14.0, 3.0]].map(|periods| Motion::new(&mut random, 1.0, 4, periods));
        let y = time.iter().map(|t| 2.0 * q.at(t - 0.3) + 0.01 * pressure.at(*t));
        let y = noisy(&mut random, NOISE, y);
        let recorded = |signal: &Motion| signal.sampled(&time);
        Trial::new(part, k, &time, vec![recorded(&q), recorded(&pressure), y])
    };
    let rig = Rig {
        actuators: vec![["q", "m"]],
        contexts: vec![["pressure", "bar"]],
        outputs: vec![["y", "N"]],
        more: String::new(),
        trials: parts(5, 2).map(trial).collect(),
    };
    let closed = close(&rig, &[]);
    assert_eq!(closed.names(), ["context_term", "dead_time"], "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}
