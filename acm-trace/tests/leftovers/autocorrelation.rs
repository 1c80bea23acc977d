//! Oracle: the correlation of the process that was planted.

use std::f64::consts::TAU;

use acm_core::record::Record;
use acm_trace::diagnose::autocorrelation::autocorrelation;

use crate::campaign::{Campaign, LARGE, SMALL};

/// First order with 0.9 from sample to sample: 0.9^k after k samples; and white noise within its bound.
#[test]
fn a_planted_process_has_its_correlation() {
    let (before, after) = (Campaign::new(LARGE, 1).noise(1e-3, 0.9), Campaign::new(LARGE, 1).noise(1e-3, 0.0));
    let found = autocorrelation(&before.remainder(), &after.remainder());
    assert!((98..=100).contains(&found.lag.len()));
    assert_eq!((found.before.len(), found.after.len()), (found.lag.len(), found.lag.len()));
    for (k, (lag, rho)) in found.lag.iter().zip(&found.before).enumerate() {
        assert!((lag - 0.1 * (k + 1) as f64).abs() < 0.01 * lag, "{lag}");
        assert!((rho - 0.9f64.powi(k as i32 + 1)).abs() < 0.09, "{k} {rho}");
    }
    let outside = found.after.iter().filter(|rho| rho.abs() > found.white).count();
    assert!(outside <= 12, "{outside} of 100");
    // 16 trials of 497 samples and three outputs.
    assert!((found.white / (1.96 / (3.0 * 16.0 * 497.0f64).sqrt()) - 1.0).abs() < 0.05);
}

/// Trials that are off keep the correlation up; outputs that are one and the same count once.
#[test]
fn offsets_stay_and_copies_do_not_count() {
    let level = |k: usize, r: &Record| vec![if k % 2 == 0 { 1e-3 } else { -1e-3 }; r.samples()];
    let off = (0..3).fold(Campaign::new(SMALL, 2), |off, m| off.on_output(m, level));
    let found = autocorrelation(&off.remainder(), &off.remainder());
    assert!(found.before.iter().all(|rho| (rho - 1.0).abs() < 1e-9));
    assert!((found.white / (1.96 / (4.0 * 247.0f64).sqrt()) - 1.0).abs() < 1e-9);
}

/// Nothing left at all.
#[test]
fn nothing_has_no_correlation() {
    let nothing = Campaign::new(SMALL, 3);
    let found = autocorrelation(&nothing.remainder(), &nothing.remainder());
    assert!(found.lag.is_empty() && found.white == 0.0);
}

/// A sine of 1 Hz, of which every second second does not count: its correlation is the cosine, at lags that pairs have.
#[test]
fn pairs_are_not_taken_across_a_gap() {
    let wave = |k: usize, r: &Record| r.time.iter().map(|t| 1e-3 * (TAU * t + k as f64).sin()).collect();
    let mut campaign = Campaign::new(LARGE, 4).on_output(1, wave);
    campaign.counts.iter_mut().flat_map(|counts| counts.iter_mut().enumerate()).for_each(|(t, c)| *c = t % 20 < 10);
    let found = autocorrelation(&campaign.remainder(), &campaign.remainder());
    for (lag, rho) in found.lag.iter().zip(&found.before).take(8) {
        assert!((rho - (TAU * lag).cos()).abs() < 0.12, "{lag} {rho}");
    }
}
