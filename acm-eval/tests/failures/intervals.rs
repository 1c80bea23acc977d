//! Class 11: intervals cover the truth, and are hardly wider than the noise makes them.

use crate::closed::{Fitted, close};
use crate::motion::{Motion, Random, clock};
use crate::rig::{Rig, Trial, noisy};

const DELAY: f64 = 0.2;
const SEEDS: u64 = 6;

/// Samples per trial, and the time between them, s.
const SAMPLES: usize = 300;
const STEP: f64 = 0.05;

/// White noise, and a coloured one with its correlation time, s.
const WHITE: f64 = 0.02;
const COLOURED: f64 = 0.1;
const MEMORY: f64 = 0.5;

/// Stationary noise with the covariance of [`covariance`].
fn coloured(random: &mut Random) -> Vec<f64> {
    let kept = (-STEP / MEMORY).exp();
    let mut at = COLOURED * random.normal();
    let step = |_| {
        let now = at;
        at = kept * at + COLOURED * (1.0 - kept * kept).sqrt() * random.normal();
        now
    };
    (0..SAMPLES).map(step).collect()
}

/// Of the noise of two samples of a trial.
fn covariance(i: usize, j: usize) -> f64 {
    let white = if i == j { WHITE * WHITE } else { 0.0 };
    white + COLOURED * COLOURED * (-(i.abs_diff(j) as f64) * STEP / MEMORY).exp()
}

/// The delay that is found in six trials of which four develop it, and half the width of the interval of one whose only
/// unknown is the delay: 1.96 √(sᵀ C s) / sᵀ s with the slopes s of the output.
fn fitted(seed: u64) -> (Fitted, f64) {
    let time = clock(SAMPLES, STEP);
    let (mut curvature, mut variance) = (0.0, 0.0);
    let trials = (0..6).map(|k| {
        let part = if k < 4 { 'd' } else { 'h' };
        let mut random = Random::new(seed + k as u64);
        let q = Motion::new(&mut random, 0.8, 3, [8.0, 1.5]);
        if part == 'd' {
            let s: Vec<f64> = time.iter().map(|t| q.speed(t - DELAY)).collect();
            curvature += s.iter().map(|s| s * s).sum::<f64>();
            let row = |i: usize| (0..SAMPLES).map(|j| covariance(i, j) * s[j]).sum::<f64>() * s[i];
            variance += (0..SAMPLES).map(row).sum::<f64>();
        }
        let clean = coloured(&mut random);
        let y = noisy(&mut random, WHITE, time.iter().zip(clean).map(|(t, e)| q.at(t - DELAY) + e));
        Trial::new(part, k, &time, vec![q.sampled(&time), y])
    });
    let rig = Rig::one_to_one("rad", "N", trials.collect());
    let closed = close(&rig, &["--set", "effects.only=[\"dead_time\"]"]);
    (closed.parameter("dead_time", "delay"), 1.96 * f64::sqrt(variance) / curvature)
}

#[test]
fn intervals_of_a_delay_cover_it_and_are_narrow() {
    let (mut covered, mut width) = (0, 0.0);
    for seed in 0..SEEDS {
        let (delay, ideal) = fitted(151 + 100 * seed);
        println!("{delay:?}, ± {ideal} at best");
        covered += u64::from(delay.covers(DELAY));
        width += 0.5 * (delay.high - delay.low) / ideal / SEEDS as f64;
    }
    println!("{covered} of {SEEDS} cover, {width} times as wide as the noise makes them");
    assert!(covered + 1 >= SEEDS && width < 1.8, "{covered} of {SEEDS}, {width} times");
}
