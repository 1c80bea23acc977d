//! Class 8: the degree of the nominal map is chosen by what it predicts.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.05;

/// A plane over six actuators, which move twice as far in held-out trials as in development.
#[test]
fn a_plane_over_six_actuators_does_not_extrapolate_as_a_cubic() {
    let time = clock(200, 0.1);
    let weights = [1.0, -0.5, 0.8, 0.3, -1.2, 0.6];
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(101 + k as u64);
        let size = if part == 'd' { 0.5 } else { 1.0 };
        let q: Vec<Motion> = (0..6).map(|_| Motion::new(&mut random, size, 2, [15.0, 5.0])).collect();
        let plane = |t: f64| q.iter().zip(weights).map(|(q, w)| w * q.at(t)).sum();
        let y = noisy(&mut random, NOISE, time.iter().map(|t| plane(*t)));
        let mut columns: Vec<Vec<f64>> = q.iter().map(|q| q.sampled(&time)).collect();
        columns.push(y);
        Trial::new(part, k, &time, columns)
    };
    let rig = Rig {
        actuators: vec![["q1", "rad"], ["q2", "rad"], ["q3", "rad"], ["q4", "rad"], ["q5", "rad"], ["q6", "rad"]],
        contexts: vec![],
        outputs: vec![["y", "N"]],
        more: String::new(),
        trials: parts(4, 2).map(trial).collect(),
    };
    let closed = close(&rig, &[]);
    assert!(closed.names().is_empty(), "{closed}");
    assert!(closed.after() < 1.2 * NOISE, "{closed}");
}
