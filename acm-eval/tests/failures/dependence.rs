//! Class 7: a size that depends on a signal is a candidate of its own.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.02;

/// Force of three axes: f = 2 q₁ + q₂ − q₃ + 0.4 i tanh(q̇₁/v), v = 0.05 rad/s. The field i is reversed from trial to trial, so that
/// friction that does not depend on it gains nothing.
#[test]
fn a_friction_that_a_field_reverses_is_found() {
    let time = clock(400, 0.03);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(91 + k as u64);
        let q: [Motion; 3] = std::array::from_fn(|_| Motion::new(&mut random, 0.8, 4, [6.0, 1.0]));
        let heat = Motion::new(&mut random, 0.8, 4, [20.0, 5.0]);
        let field = if k % 2 == 0 { 1.0 } else { -1.0 };
        let force = |t: f64| 2.0 * q[0].at(t) + q[1].at(t) - q[2].at(t) + 0.4 * field * (q[0].speed(t) / 0.05).tanh();
        let f = noisy(&mut random, NOISE, time.iter().map(|t| force(*t)));
        let recorded = |signal: &Motion| signal.sampled(&time);
        let mut columns: Vec<Vec<f64>> = q.iter().map(recorded).collect();
        columns.extend([vec![field; time.len()], recorded(&heat), f]);
        Trial::new(part, k, &time, columns)
    };
    let rig = Rig {
        actuators: vec![["q1", "rad"], ["q2", "rad"], ["q3", "rad"]],
        contexts: vec![["field", "A"], ["heat", "K"]],
        outputs: vec![["f", "N"]],
        more: String::new(),
        trials: parts(6, 2).map(trial).collect(),
    };
    let closed = close(&rig, &[]);
    assert_eq!(closed.names(), ["coulomb_friction per field"], "{closed}");
    assert!(closed.parameter("coulomb_friction", "friction_f per field").is_within(0.05, 0.4), "{closed}");
    assert!(closed.after() < 1.3 * NOISE, "{closed}");
}
