//! Class 12: what is said is said of development trials; held-out trials confirm it or not.

use crate::closed::{Closed, close};
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

/// A delay of 0.3 s; in held-out trials the output is moreover spoiled by slow waves of a size.
fn closed(spoiled: f64) -> Closed {
    let time = clock(400, 0.05);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(171 + k as u64);
        let q = Motion::new(&mut random, 0.8, 3, [8.0, 1.2]);
        let wave = Motion::new(&mut random, if part == 'h' { spoiled } else { 0.0 }, 3, [9.0, 2.0]);
        let y = noisy(&mut random, 1e-3, time.iter().map(|t| 0.1 * q.at(t - 0.3) + wave.at(*t)));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(4, 2).map(trial).collect();
    close(&Rig::one_to_one("rad", "m", trials), &[])
}

#[test]
fn held_out_trials_do_not_change_the_verdict() {
    let [clean, spoiled] = [0.0, 0.03].map(closed);
    assert_eq!((clean.verdict(), spoiled.verdict()), ("named", "named"), "{clean}\n{spoiled}");
    assert_eq!(clean.found["effects"], spoiled.found["effects"], "{clean}\n{spoiled}");
    assert!(spoiled.after() > 5.0 * clean.after(), "{clean}\n{spoiled}");
}
