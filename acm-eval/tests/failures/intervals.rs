//! Class 11: intervals cover the truth, and are hardly wider than the noise makes them.

use crate::closed::close;
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const DELAY: f64 = 0.2;
const NOISE: f64 = 0.02;
const SEEDS: u64 = 6;

/// Oracle: least squares of one delay under white noise has ± 1.96 σ / √(Σ (dy/dt)²).
#[test]
fn intervals_of_a_delay_cover_it_and_are_narrow() {
    let time = clock(300, 0.05);
    let (mut covered, mut widths) = (0, 0.0);
    for seed in 0..SEEDS {
        let mut slopes = 0.0;
        let trials = (0..6).map(|k| {
            let part = if k < 4 { 'd' } else { 'h' };
            let mut random = Random::new(151 + 100 * seed + k as u64);
            let q = Motion::new(&mut random, 0.8, 3, [8.0, 1.5]);
            if part == 'd' {
                slopes += time.iter().map(|t| q.speed(t - DELAY).powi(2)).sum::<f64>();
            }
            let y = noisy(&mut random, NOISE, time.iter().map(|t| q.at(t - DELAY)));
            Trial::new(part, k, &time, vec![time.iter().map(|t| q.at(*t)).collect(), y])
        });
        let closed = close(&Rig::one_to_one("rad", "N", trials.collect()), &["--set", "effects.only=[\"dead_time\"]"]);
        let delay = closed.parameter("dead_time", "delay");
        covered += u64::from(delay.covers(DELAY));
        widths += 0.5 * (delay.high - delay.low) / (1.96 * NOISE / f64::sqrt(slopes)) / SEEDS as f64;
    }
    println!("{covered} of {SEEDS} cover, {widths} times as wide as the noise makes them");
    assert!(covered + 1 >= SEEDS && widths < 2.0, "{covered} of {SEEDS}, {widths} times");
}
