//! Oracle: the batch path, which sees whole stretches or windows at once, from a state of zero.

use acm_kernels::{Keep, Kernel, Sequences};
use acm_stream::{ChannelRange, Estimator, Parts, StateRule};
use nalgebra::DMatrix;

use crate::robots::{FIRST, Trial, bodies, cfc, parts, polynomial, trial};

/// Standardised channels and elapsed times of a stretch, as training lays them out.
fn stretch(trial: &Trial, parts: &Parts, rows: std::ops::Range<usize>, first: usize) -> (Vec<f32>, Vec<f32>) {
    let (mut channels, mut elapsed) = (vec![], vec![]);
    for t in rows {
        let [q1, q2, temperature] = trial.inputs[t];
        let step = trial.time[t] - trial.time[t.max(1) - 1];
        let rate = if t == first { 0.0 } else { (q1 - trial.inputs[t - 1][0]) / step };
        let scaler = parts.inputs.mean.iter().zip(&parts.inputs.spread);
        let values = [q1, q2, rate, temperature];
        channels.extend(values.iter().zip(scaler).map(|(x, (mean, spread))| ((x - mean) / spread) as f32));
        elapsed.push(if t == first { FIRST } else { step } as f32);
    }
    (channels, elapsed)
}

fn infer(parts: &Parts, (inputs, elapsed): &(Vec<f32>, Vec<f32>), keep: Keep) -> Vec<f32> {
    let kernel = Kernel::new(&parts.network).expect("a network");
    let sequences = Sequences { inputs, elapsed, state: None, batch: 1, steps: elapsed.len(), keep };
    let mut predictions = vec![0.0; kernel.predictions(&sequences)];
    kernel.infer(&parts.weights, &sequences, &mut kernel.workspace(), &mut predictions);
    predictions
}

/// Nominal model and residual at a sample.
fn answer(trial: &Trial, t: usize, prediction: f32) -> f64 {
    let q = DMatrix::from_row_slice(1, 2, &trial.inputs[t][..2]);
    polynomial().predict(&q)[(0, 1)] + 0.03 * f64::from(prediction) + 0.002
}

#[test]
fn a_running_state_is_the_batch_over_a_stretch() {
    let trial = trial();
    for body in bodies() {
        let parts = parts(body, StateRule::Running);
        let found = trial.through(&mut Estimator::new(parts.clone()).expect("parts that fit"));
        for segment in trial.segments() {
            let batch = infer(&parts, &stretch(&trial, &parts, segment.clone(), segment.start), Keep::Every);
            for (t, prediction) in segment.zip(batch) {
                let off = (found[t][0] - answer(&trial, t, prediction)).abs();
                assert!(off < 1e-5 * 0.03, "{:?}: {off:.1e} at sample {t}", parts.network.body);
            }
        }
    }
}

#[test]
fn a_window_is_what_is_scored() {
    const WINDOW: usize = 3;
    let trial = trial();
    for body in bodies() {
        let parts = parts(body, StateRule::Window(WINDOW));
        let found = trial.through(&mut Estimator::new(parts.clone()).expect("parts that fit"));
        for segment in trial.segments() {
            for t in segment.clone() {
                // Before a window is full, it is what there is since the start.
                let first = segment.start.max((t + 1).saturating_sub(WINDOW));
                let batch = infer(&parts, &stretch(&trial, &parts, first..t + 1, segment.start), Keep::Last);
                let off = (found[t][0] - answer(&trial, t, batch[0])).abs();
                assert!(off < 1e-5 * 0.03, "{:?}: {off:.1e} at sample {t}", parts.network.body);
            }
        }
    }
}

/// The two rules differ where a state is older than the window, unless the network has none.
#[test]
fn rules_part_after_a_window() {
    let trial = trial();
    for body in bodies() {
        let under = |state| trial.through(&mut Estimator::new(parts(body.clone(), state)).expect("parts that fit"));
        let (running, window) = (under(StateRule::Running), under(StateRule::Window(3)));
        assert_eq!(running[..3], window[..3]);
        let remembers = !matches!(body, acm_kernels::Body::Mlp(_));
        assert_eq!(running[20] != window[20], remembers, "{body:?}");
    }
}

/// Oracle: an estimator to which the samples that the network does not see are never shown. Ten in a row are a gap.
#[test]
fn what_the_network_does_not_see_is_time_that_passes() {
    let trial = trial();
    let seen = |t: usize| t % 5 != 3 && !(80..90).contains(&t) && t > 0;
    for state in [StateRule::Running, StateRule::Window(3)] {
        for body in bodies() {
            let fresh = || Estimator::new(parts(body.clone(), state)).expect("parts that fit");
            let (mut all, mut some, mut before) = (fresh(), fresh(), 0.0);
            for (t, inputs) in trial.inputs.iter().enumerate() {
                let elapsed = trial.time[t] - trial.time[t.max(1) - 1];
                if seen(t) {
                    let found = all.step(inputs, elapsed).expect("a sample")[0];
                    let expected = some.step(inputs, trial.time[t] - before).expect("a sample")[0];
                    assert!((found - expected).abs() < 1e-7, "{body:?} at sample {t}");
                    assert_eq!(all.history(), some.history());
                    before = trial.time[t];
                } else {
                    all.step_unseen(inputs, elapsed).expect("a sample");
                    assert_eq!(all.tip(), all.nominal());
                }
            }
        }
    }
}

#[test]
fn a_restart_is_a_beginning() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(5)] {
        for body in bodies() {
            let mut estimator = Estimator::new(parts(body, state)).expect("parts that fit");
            let first = trial.through(&mut estimator);
            estimator.restart();
            assert_eq!(estimator.history(), 0);
            assert_eq!(first, trial.through(&mut estimator));
        }
    }
}

/// Parts that went through a file answer with the same bits.
#[test]
fn a_file_keeps_every_bit() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(5)] {
        for body in bodies() {
            let parts = parts(body, state);
            let bytes = parts.to_json().expect("it can be written");
            let read = Parts::from_json(&bytes).expect("it can be read");
            let through = |parts| trial.through(&mut Estimator::new(parts).expect("parts that fit"));
            assert_eq!(through(read), through(parts));
        }
    }
}

/// A file from before there were ranges is read, and then nothing is said of them.
#[test]
fn a_file_without_ranges_is_read() {
    let mut parts = parts(cfc(4, 4), StateRule::Running);
    let old = parts.to_json().expect("it can be written");
    assert!(!String::from_utf8_lossy(&old).contains("ranges"));
    let trial = trial();
    let through = |parts| {
        let mut estimator = Estimator::new(parts).expect("parts that fit");
        (trial.through(&mut estimator), estimator.in_range())
    };
    let (answers, in_range) = through(Parts::from_json(&old).expect("it can be read"));
    assert_eq!(in_range, None);
    parts.ranges = Some(vec![ChannelRange { low: -1e3, high: 1e3 }; 4]);
    let new = parts.to_json().expect("it can be written");
    let read = Parts::from_json(&new).expect("it can be read");
    assert_eq!(read.ranges, parts.ranges);
    assert_eq!(through(read), (answers, Some(true)));
}

#[test]
fn a_step_allocates_nothing() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(5)] {
        for body in bodies() {
            let mut estimator = Estimator::new(parts(body, state)).expect("parts that fit");
            let counted = allocation_counter::measure(|| {
                for inputs in &trial.inputs {
                    assert!(estimator.step(inputs, 0.1).is_ok());
                    assert!(estimator.step(&[1e308, 0.0, 300.0], 0.1).is_err());
                }
                estimator.restart();
            });
            assert_eq!(counted.count_total, 0, "{:?}", estimator.parts().network.body);
        }
    }
}
