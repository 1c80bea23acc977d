//! Window counts; oracle: arithmetic by hand.

use acm_datasets::{Series, Standardizer, WindowSpec, segments, windows};
use nalgebra::DMatrix;

fn one(time: Vec<f64>, max_gap: f64) -> Series {
    let n = time.len();
    let zeros = || DMatrix::zeros(n, 1);
    Series {
        trial: "t".into(),
        elapsed: vec![0.02; n],
        inputs: DMatrix::from_fn(n, 1, |t, _| t as f64),
        target: zeros(),
        nominal: zeros(),
        measured: zeros(),
        segments: segments(&time, max_gap),
        slopes: DMatrix::zeros(0, 0),
        time,
    }
}

/// 50 Hz, samples 0…999 without 300–319 and 700.
fn record(max_gap: f64) -> Series {
    let kept = (0..1000).filter(|k| !(300..320).contains(k) && *k != 700);
    one(kept.map(|k| f64::from(k) * 0.02).collect(), max_gap)
}

/// 0.1 s: stretches of 300 and 679 samples, ⌊250/10⌋ + 1 = 26 and ⌊629/10⌋ + 1 = 63 windows.
/// 0.03 s: 300, 380 and 299 samples, 26 + 34 + 25.
#[test]
fn windows_of_the_gapped_record() {
    let spec = WindowSpec { length: 50, reach: 50, stride: 10 };
    assert_eq!(windows(&[record(0.1)], &spec).len(), 89);
    assert_eq!(windows(&[record(0.03)], &spec).len(), 85);
}

/// The paper's windows: N samples that end at k, stride 1: T − N + 1 of them.
#[test]
fn windows_of_the_paper() {
    let whole = one((0..200).map(|k| f64::from(k) * 0.1).collect(), 0.5);
    for length in [1, 25, 50, 200] {
        let found = windows(std::slice::from_ref(&whole), &WindowSpec { length, reach: length, stride: 1 });
        assert_eq!(found.len(), 200 - length + 1);
        assert_eq!(found[0].rows(length), 0..length);
        assert_eq!(found.last().map(|w| w.end), Some(199));
    }
    assert!(windows(&[whole], &WindowSpec { length: 201, reach: 201, stride: 1 }).is_empty());
}

/// Oracle: by hand. Of 20 samples, 3–5 and 9 lack their output: windows of 4 hold their inputs and end at the others.
#[test]
fn windows_hold_samples_without_an_output_and_end_at_none() {
    let mut whole = one((0..20).map(|k| f64::from(k) * 0.1).collect(), 0.5);
    [3, 4, 5, 9].into_iter().for_each(|lost| whole.measured[(lost, 0)] = f64::NAN);
    let ends = |stride| {
        let found = windows(std::slice::from_ref(&whole), &WindowSpec { length: 4, reach: 4, stride });
        found.iter().map(|window| window.end).collect::<Vec<_>>()
    };
    assert_eq!(ends(1)[..4], [6, 7, 8, 10]);
    assert_eq!(ends(3), [6, 10, 13, 16, 19]);
    assert_eq!(whole.targets().nrows(), 16);
}

/// A model with a window of 1 and one of 50 are scored at the same targets, in the same order.
#[test]
fn all_models_have_the_same_targets() {
    let all = [record(0.03), record(0.1)];
    let targets = |length, stride| windows(&all, &WindowSpec { length, reach: 50, stride });
    assert_eq!(targets(1, 3), targets(50, 3));
    let window = targets(1, 3)[1];
    assert_eq!((window.rows(1), window.rows(50)), (52..53, 3..53));
}

/// No window crosses a gap: every window's samples lie in one segment.
#[test]
fn no_window_crosses_a_gap() {
    let record = record(0.03);
    let spec = WindowSpec { length: 25, reach: 50, stride: 7 };
    let found = windows(std::slice::from_ref(&record), &spec);
    for window in &found {
        let rows = window.rows(25);
        assert!(record.segments.iter().any(|s| s.start <= rows.start && rows.end <= s.end), "{window:?}");
    }
    // stride counts from the start of each segment
    for segment in &record.segments {
        assert!(found.iter().any(|w| w.end == segment.start + 49));
    }
}

/// Oracle: mean and spread of 0, 1, …, n − 1 in closed form.
#[test]
fn the_standardizer_takes_mean_and_spread() {
    let training = record(0.1);
    let fitted = Standardizer::fit(&[&training.inputs]);
    // 0, 1, …, n − 1: mean (n − 1)/2 and spread √((n² − 1)/12)
    let n = training.time.len() as f64;
    assert_eq!(fitted.mean, [(n - 1.0) / 2.0]);
    assert!((fitted.spread[0] - ((n * n - 1.0) / 12.0).sqrt()).abs() < 1e-9);
}
