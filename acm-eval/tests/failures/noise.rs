//! Class 9: noise of encoders is no effect.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

/// Noise of the angles, rad, and of the output, m.
const NOISES: [[f64; 2]; 2] = [[2e-3, 1e-3], [4e-3, 5e-4]];

/// Nothing is the matter but noise on the recorded angles: smoothing would take it away, and whatever smooths would pass for an
/// effect.
#[test]
fn noise_of_encoders_is_no_effect() {
    let time = clock(500, 0.05);
    for (seed, [of_angle, of_output]) in (0..3).flat_map(|seed| NOISES.map(|noises| (seed, noises))) {
        let trial = |(part, k): (char, usize)| {
            let mut random = Random::new(111 + 100 * seed + k as u64);
            let q: [Motion; 2] = std::array::from_fn(|_| Motion::new(&mut random, 0.4, 3, [8.0, 2.0]));
            let at = |t: f64| 0.3 * q[0].at(t) + 0.1 * q[1].at(t) + 0.1 * q[0].at(t) * q[1].at(t);
            let y = noisy(&mut random, of_output, time.iter().map(|t| at(*t)));
            let read = q.map(|q| noisy(&mut random, of_angle, time.iter().map(|t| q.at(*t))));
            let [a, b] = read;
            Trial::new(part, k, &time, vec![a, b, y])
        };
        let rig = Rig {
            actuators: vec![["q1", "rad"], ["q2", "rad"]],
            contexts: vec![],
            outputs: vec![["y", "m"]],
            more: String::new(),
            trials: parts(4, 2).map(trial).collect(),
        };
        let closed = close(&rig, &[]);
        assert!(closed.names().is_empty(), "seed {seed}, {of_angle} rad: {closed}");
    }
}
