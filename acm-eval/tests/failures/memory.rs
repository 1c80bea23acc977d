//! Class 5: "no recorded signal predicts it" is said only where a probe with memory agrees.

use crate::closed::close;
use crate::motion::{Motion, Random, clock, solve};
use crate::rig::{Rig, Trial, noisy};

/// A resonance that is not looked for: x'' + 2ζω x' + ω² x = ω² q, with a period of 12 s and samples every 0.2 s.
#[test]
fn a_resonance_that_is_not_looked_for_is_no_unmeasured_disturbance() {
    let (time, w, damping) = (clock(500, 0.2), 0.5, 0.1);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(71 + k as u64);
        let q = Motion::new(&mut random, 1.0, 6, [40.0, 3.0]);
        let slope = |t: f64, [x, v]: [f64; 2]| [v, w * w * (q.at(t) - x) - 2.0 * damping * w * v];
        let x = solve(&time, [q.at(0.0), 0.0], slope);
        let y = noisy(&mut random, 0.02, x.iter().map(|[x, _]| *x));
        Trial::new(part, k, &time, vec![time.iter().map(|t| q.at(*t)).collect(), y])
    };
    let trials = (0..5).map(|k| ('d', k)).chain((5..7).map(|k| ('h', k))).map(trial).collect();
    let closed = close(&Rig::one_to_one("V", "m", trials), &["--set", "effects.only=[\"saturation\"]"]);
    assert_ne!(closed.verdict(), "unmeasured disturbance", "{closed}");
    let probes = ["probe", "network"].map(|name| closed.found["left"][name]["explained"].as_f64().unwrap_or(0.0));
    assert!(probes[0].max(probes[1]) > 0.5, "{closed}");
}
