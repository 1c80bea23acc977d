//! Class 7: a size that depends on a signal is a candidate of its own.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const NOISE: f64 = 0.02;

/// Voltage of a machine: u = 2 q + 0.8 i q̇, with a field current i of either sign, so that 0.8 q̇ alone gains nothing.
#[test]
fn a_voltage_in_proportion_to_speed_and_field_is_found() {
    let time = clock(400, 0.03);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(91 + k as u64);
        let q = Motion::new(&mut random, 0.8, 4, [6.0, 1.0]);
        let current = Motion::new(&mut random, 1.0, 3, [7.0, 2.0]);
        let y = time.iter().map(|t| 2.0 * q.at(*t) + 0.8 * current.at(*t) * q.speed(*t));
        let y = noisy(&mut random, NOISE, y);
        let recorded = |signal: &Motion| time.iter().map(|t| signal.at(*t)).collect();
        Trial::new(part, k, &time, vec![recorded(&q), recorded(&current), y])
    };
    let rig = Rig {
        actuators: vec![["q", "rad"]],
        contexts: vec![["field", "A"]],
        outputs: vec![["u", "V"]],
        more: String::new(),
        trials: (0..5).map(|k| ('d', k)).chain((5..7).map(|k| ('h', k))).map(trial).collect(),
    };
    let closed = close(&rig, &[]);
    assert_eq!(closed.names(), ["viscous_friction per field"], "{closed}");
    assert!(closed.parameter("viscous_friction", "damping_u per field").is_within(0.05, 0.8), "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}
