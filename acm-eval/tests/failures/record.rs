//! Class 6: one record has blocks enough to accept an effect.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const NOISE: f64 = 0.02;

/// Viscous friction of 0.02 N·s/m, as large as the noise, in one record of 60 s of which the last 30 % are held out.
#[test]
fn one_record_is_enough_for_friction() {
    let (time, mut random) = (clock(1500, 0.04), Random::new(81));
    let q = Motion::new(&mut random, 1.0, 5, [20.0, 1.5]);
    let y = noisy(&mut random, NOISE, time.iter().map(|t| 2.0 * q.at(*t) + 0.04 * (q.speed(*t) / 0.02).tanh()));
    let record = Trial::new('d', 0, &time, vec![time.iter().map(|t| q.at(*t)).collect(), y]);
    let closed = close(&Rig::one_to_one("m", "N", vec![record]), &[]);
    assert!(closed.has(&["coulomb_friction", "dahl_friction", "output_hysteresis"]), "{closed}");
    assert!(closed.after() < 1.1 * NOISE, "{closed}");
}
