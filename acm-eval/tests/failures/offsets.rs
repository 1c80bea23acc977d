//! Class 14: an offset of each trial that nobody recorded.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.02;

/// Offsets of fifty times the noise, over a delay that moves the output by some ten times the noise.
#[test]
fn a_delay_is_found_under_offsets_of_trials() {
    let time = clock(300, 0.05);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(191 + k as u64);
        let q = Motion::new(&mut random, 0.8, 3, [8.0, 2.0]);
        let offset = 50.0 * NOISE * random.normal();
        let y = noisy(&mut random, NOISE, time.iter().map(|t| q.at(t - 0.15) + offset));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(7, 2).map(trial).collect();
    let closed = close(&Rig::one_to_one("rad", "N", trials), &[]);
    assert_eq!(closed.names(), ["dead_time"], "{closed}");
    assert!(closed.parameter("dead_time", "delay").is_within(0.1, 0.15), "{closed}");
    let left = closed.found["errors"]["after_without_offsets"]["value"].as_f64().expect("offsets are told");
    assert!(left < 1.1 * NOISE, "{closed}");
}
