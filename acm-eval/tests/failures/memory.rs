//! Class 5: "no recorded signal explains it" is said only where a probe with memory agrees.

use crate::closed::close;
use crate::motion::{Motion, Random, clock, lag};
use crate::rig::{Rig, Trial, noisy, parts};

/// y = q₁ + x₁ x₂, 8 ẋ = q − x: a product of two slow lags. No effect is looked for but one that is not there.
#[test]
fn a_product_of_slow_lags_is_no_unmeasured_disturbance() {
    let time = clock(800, 0.1);
    for seed in [71, 171] {
        let trial = |(part, k): (char, usize)| {
            let mut random = Random::new(seed + k as u64);
            let q: [Motion; 2] = std::array::from_fn(|_| Motion::new(&mut random, 1.0, 4, [40.0, 5.0]));
            let [a, b] = [0, 1].map(|i| lag(&time, 8.0, |t| q[i].at(t)));
            let y = noisy(&mut random, 0.02, (0..time.len()).map(|k| q[0].at(time[k]) + a[k] * b[k]));
            let [first, second] = q.map(|q| q.sampled(&time));
            Trial::new(part, k, &time, vec![first, second, y])
        };
        let rig = Rig {
            actuators: vec![["q1", "V"], ["q2", "V"]],
            contexts: vec![],
            outputs: vec![["y", "m"]],
            more: String::new(),
            trials: parts(5, 2).map(trial).collect(),
        };
        let closed = close(&rig, &["--set", "effects.only=[\"saturation\"]"]);
        assert_ne!(closed.verdict(), "unmeasured disturbance", "{closed}");
        let probes = ["probe", "network"].map(|name| closed.found["left"][name]["explained"].as_f64().unwrap_or(0.0));
        assert!(probes[0].max(probes[1]) > 0.5, "{closed}");
    }
}
