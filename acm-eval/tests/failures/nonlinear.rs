//! Class 15: nonlinearity before or inside the dynamics.

use crate::closed::{Closed, close};
use crate::motion::{Motion, Random, clock, solve};
use crate::rig::{Rig, Trial, noisy, parts};

const NOISE: f64 = 0.005;

/// Four trials and two held out; the plant starts where it would rest.
fn closed(seed: u64, step: f64, periods: [f64; 2], plant: impl Fn(&[f64], &Motion) -> Vec<f64>) -> Closed {
    let time = clock(500, step);
    let trial = |(part, k): (char, usize)| {
        let mut random = Random::new(seed + k as u64);
        let q = Motion::new(&mut random, 0.5, 4, periods);
        let y = noisy(&mut random, NOISE, plant(&time, &q));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    };
    let trials = parts(4, 2).map(trial).collect();
    close(&Rig::one_to_one("V", "m", trials), &[])
}

/// Torricelli: ḣ = 0.2 (1 + q/2) − 0.2 √h.
#[test]
fn a_tank_that_empties_by_torricelli_is_found() {
    let closed = closed(211, 1.0, [150.0, 20.0], |time, q| {
        let pump = |t: f64| 1.0 + q.at(t) / 2.0;
        let start = pump(0.0).powi(2);
        solve(time, [start], |t, [h]| [0.2 * (pump(t) - h.max(0.0).sqrt())]).into_iter().map(|[h]| h).collect()
    });
    assert!(closed.has(&["outflow"]), "{closed}");
    assert!(closed.after() < 1.5 * NOISE, "{closed}");
}

/// Duffing: z'' + 2ζω z' + ω² (z + c z³) = ω² q.
#[test]
fn a_hardening_spring_is_found() {
    for [damping, cube] in [[0.3, 0.5], [0.15, 1.0]] {
        let w = 3.0;
        let closed = closed(221, 0.05, [10.0, 1.5], |time, q| {
            let force = |z: f64| z + cube * z.powi(3);
            let slope = |t: f64, [z, v]: [f64; 2]| [v, w * w * (q.at(t) - force(z)) - 2.0 * damping * w * v];
            let newton = |z: f64, _| z - (force(z) - q.at(0.0)) / (1.0 + 3.0 * cube * z * z);
            solve(time, [(0..50).fold(0.0, newton), 0.0], slope).into_iter().map(|[z, _]| z).collect()
        });
        assert!(closed.has(&["nonlinear_stiffness"]), "{damping}: {closed}");
        assert!(closed.after() < 1.5 * NOISE, "{damping}: {closed}");
    }
}
