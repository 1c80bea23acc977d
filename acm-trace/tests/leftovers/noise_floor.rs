//! Oracle: the noise that was planted.

use acm_trace::diagnose::noise_floor::{noise_floor, noise_floor_of};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::campaign::{Campaign, LARGE, SMALL, normal};

/// Three outputs of 1 mm each: √3 mm, on irregular time stamps, with and without motion below it.
#[test]
fn planted_noise_comes_back() {
    let noise = Campaign::new(LARGE, 1).noise(1e-3, 0.0);
    let truth = 1e-3 * 3f64.sqrt();
    let alone = noise_floor(&noise.remainder());
    assert!((alone / truth - 1.0).abs() < 0.02, "{}", alone / truth);
    let moving = noise.on_actuator(0, |_, r| r.actuators[0].iter().map(|q| 0.05 * q.sin()).collect());
    let found = noise_floor(&moving.remainder());
    assert!((found / truth - 1.0).abs() < 0.03, "{}", found / truth);
}

/// One sample in fifty is off by 20 standard deviations, and one trial slips: neither is noise.
#[test]
fn spikes_and_slips_are_no_noise() {
    let spikes = Campaign::new(LARGE, 2)
        .noise(1e-3, 0.0)
        .on_output(1, |_, r| (0..r.samples()).map(|t| if t % 50 == 7 { 0.02 } else { 0.0 }).collect())
        .on_actuator(0, |k, r| r.time.iter().map(|t| if k == 3 && *t > 20.0 { 0.1 } else { 0.0 }).collect());
    let found = noise_floor(&spikes.remainder()) / (1e-3 * 3f64.sqrt());
    assert!((0.97..1.06).contains(&found), "{found}");
}

/// Half of the trials have three times the noise: the mean square counts, not the median.
#[test]
fn noise_that_differs_keeps_its_mean_square() {
    let mut uneven = Campaign::new(LARGE, 3).noise(1e-3, 0.0);
    for residual in uneven.residuals.iter_mut().step_by(2) {
        residual.iter_mut().for_each(|r| *r *= 3.0);
    }
    let found = noise_floor(&uneven.remainder()) / (1e-3 * (3.0 * 5.0f64).sqrt());
    assert!((found - 1.0).abs() < 0.03, "{found}");
}

/// A record of 100 Hz with motion of 1 Hz and 0.4 mm of noise; thinned to 10 Hz the motion would drown the noise. Gaps
/// and lost samples do not matter. 5 %: three standard deviations of 6000 samples' estimate.
#[test]
fn the_full_rate_sees_the_noise_below_the_motion() {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let time: Vec<f64> = (0..6000).map(|t| 0.01 * f64::from(t) + if t > 3000 { 2.0 } else { 0.0 }).collect();
    let motion = |t: &f64| 0.05 * (std::f64::consts::TAU * t).sin();
    let mut measured: Vec<f64> = time.iter().map(|t| motion(t) + 4e-4 * normal(&mut random)).collect();
    measured[100..130].fill(f64::NAN);
    let found = noise_floor_of(&time, &[measured.clone(), measured.clone()]) / (4e-4 * 2f64.sqrt());
    assert!((found - 1.0).abs() < 0.05, "{found}");
    let thin = |x: &[f64]| x.iter().copied().step_by(10).collect::<Vec<f64>>();
    assert!(noise_floor_of(&thin(&time), &[thin(&measured)]) > 10.0 * 4e-4);
}

/// What is too short or does not move has no noise, and nothing panics.
#[test]
fn nothing_has_no_noise() {
    assert_eq!(noise_floor(&Campaign::new(SMALL, 5).remainder()), 0.0);
    assert_eq!(noise_floor_of(&[], &[vec![]]), 0.0);
    assert_eq!(noise_floor_of(&[0.0, 1.0], &[vec![1.0, 2.0]]), 0.0);
    assert_eq!(noise_floor_of(&[0.0, 1.0, 2.0], &[vec![1.0, f64::NAN, 2.0]]), 0.0);
}

/// Second-long looks at a motion of 0.2 Hz with pauses of four seconds: what happens in a pause is no noise.
#[test]
fn pauses_are_not_bridged() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let time: Vec<f64> = (0..4000).map(|k| 0.1 * f64::from(k) + 4.0 * f64::from(k / 10)).collect();
    let seen = |t: &f64| 0.05 * (1.2345 * t).sin() + 1e-3 * normal(&mut random);
    let found = noise_floor_of(&time, &[time.iter().map(seen).collect()]) / 1e-3;
    assert!((found - 1.0).abs() < 0.06, "{found}");
}
