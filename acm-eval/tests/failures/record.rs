//! Class 6: one record has blocks enough to accept an effect.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const NOISE: f64 = 0.02;
const FRICTION: f64 = 0.06;

/// When the motion sets in, s; each spell lasts 9 s.
const SPELLS: [f64; 3] = [8.0, 30.0, 46.0];

/// The time that moves on during spells alone, and its rate: each begins and ends with a ramp of 1 s.
fn moved(t: f64) -> (f64, f64) {
    let ramp = |x: f64| if x < 1.0 { 0.5 * x.max(0.0).powi(2) } else { x - 0.5 };
    let of = |start: &f64| ramp(t - start) - ramp(t - start - 8.0);
    let rate = |start: &f64| (t - start).clamp(0.0, 1.0) - (t - start - 8.0).clamp(0.0, 1.0);
    (SPELLS.iter().map(of).sum(), SPELLS.iter().map(rate).sum())
}

/// One record of a minute with pauses; the last 30 % are held out.
#[test]
fn one_record_with_pauses_is_enough_for_friction() {
    for seed in [94, 95] {
        let (time, mut random) = (clock(1500, 0.04), Random::new(seed));
        let q = Motion::new(&mut random, 1.0, 5, [20.0, 1.5]);
        let force = |t: f64| {
            let (at, rate) = moved(t);
            2.0 * q.at(at) + FRICTION * (rate * q.speed(at) / 0.02).tanh()
        };
        let y = noisy(&mut random, NOISE, time.iter().map(|t| force(*t)));
        let record = Trial::new('d', 0, &time, vec![time.iter().map(|t| q.at(moved(*t).0)).collect(), y]);
        let closed = close(&Rig::one_to_one("m", "N", vec![record]), &[]);
        assert!(closed.has(&["coulomb_friction"]), "{closed}");
        assert!(closed.parameter("coulomb_friction", "friction").is_within(0.1, FRICTION), "{closed}");
        assert!(closed.after() < 1.1 * NOISE, "{closed}");
    }
}
