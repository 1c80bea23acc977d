//! Samples and parts that cannot be taken.

use acm_stream::{ChannelRange, Estimator, Nominal, Parts, Source, StateRule, StepError};

use crate::robots::{bodies, cfc, parts, trial};

/// A sample that is refused leaves no trace.
#[test]
fn refused_samples_change_nothing() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(4)] {
        for body in bodies() {
            let fresh = || Estimator::new(parts(body.clone(), state)).expect("parts that fit");
            let (mut clean, mut spoiled) = (fresh(), fresh());
            for (t, inputs) in trial.inputs.iter().enumerate().take(20) {
                let bad = [inputs[0], f64::NAN, inputs[2]];
                assert!(matches!(spoiled.step(&bad, 0.1), Err(StepError::NotFinite { index: 1, .. })));
                let found = spoiled.step(&inputs[..2], 0.1);
                assert_eq!(found, Err(StepError::Count { found: 2, needed: 3 }));
                for elapsed in [0.0, -0.1, f64::NAN, f64::INFINITY] {
                    let refused = t == 0 || matches!(spoiled.step(inputs, elapsed), Err(StepError::Elapsed { .. }));
                    assert!(refused, "{elapsed} s");
                }
                assert_eq!(clean.step(inputs, 0.1), spoiled.step(inputs, 0.1));
            }
        }
    }
}

/// Numbers that overflow on their way are refused, and leave no trace, not even after a gap.
#[test]
fn what_overflows_changes_nothing() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(4)] {
        for body in bodies() {
            let fresh = || {
                let mut parts = parts(body.clone(), state);
                parts.ranges = Some(vec![ChannelRange { low: -10.0, high: 310.0 }; 4]);
                Estimator::new(parts).expect("parts that fit")
            };
            let (mut clean, mut spoiled) = (fresh(), fresh());
            for (t, inputs) in trial.inputs.iter().enumerate().take(20) {
                let elapsed = if t % 7 == 3 { 2.0 } else { 0.1 };
                let answer = |of: &Estimator| (of.tip().to_vec(), of.nominal().to_vec(), of.history(), of.in_range());
                let before = answer(&spoiled);
                for bad in [[1e308, inputs[1], inputs[2]], [inputs[0], inputs[1], 1e308]] {
                    for elapsed in [0.05, 5.0] {
                        let refused = spoiled.step(&bad, elapsed).map(<[f64]>::to_vec);
                        assert!(matches!(refused, Err(StepError::Overflow { .. })), "{refused:?}");
                    }
                }
                assert_eq!(answer(&spoiled), before);
                assert_eq!(clean.step(inputs, elapsed), spoiled.step(inputs, elapsed), "sample {t}");
                assert_eq!(answer(&clean), answer(&spoiled));
                assert_eq!(clean.in_range(), Some(true));
            }
        }
    }
}

/// Prediction and network are finite, their sum is not: the state is taken back.
#[test]
fn an_answer_that_overflows_leaves_the_state_alone() {
    let trial = trial();
    for state in [StateRule::Running, StateRule::Window(4)] {
        for body in bodies() {
            let fresh = || {
                let mut parts = parts(body.clone(), state);
                parts.nominal = Nominal::Given(2);
                (parts.targets.mean[0], parts.targets.spread[0]) = (6e289, 1e288);
                Estimator::new(parts).expect("parts that fit")
            };
            let (mut clean, mut spoiled) = (fresh(), fresh());
            for (t, inputs) in trial.inputs.iter().enumerate().take(20) {
                let elapsed = if t % 7 == 3 { 2.0 } else { 0.1 };
                let with = |prediction: f64, more: f64| [inputs[0] + more, inputs[1], inputs[2], 0.0, prediction];
                for elapsed in [0.05, 5.0] {
                    let refused = spoiled.step(&with(9e289, 0.5), elapsed).map(<[f64]>::to_vec);
                    assert!(matches!(refused, Err(StepError::Overflow { what: "output", .. })), "{refused:?}");
                }
                assert_eq!(clean.step(&with(0.0, 0.0), elapsed), spoiled.step(&with(0.0, 0.0), elapsed), "sample {t}");
            }
        }
    }
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut Parts)| {
        let mut parts = parts(cfc(4, 4), StateRule::Running);
        change(&mut parts);
        let Err(error) = Estimator::new(parts) else { panic!("not refused") };
        error.to_string()
    };
    let cases: [(&str, &dyn Fn(&mut Parts)); 12] = [
        ("actuators: 1 where 2", &|parts| parts.signals.actuators.truncate(1)),
        ("channel 3 is Context(0)", &|parts| parts.signals.contexts.clear()),
        ("channel 0 is Actuator(2)", &|parts| parts.channels[0].source = Source::Actuator(2)),
        ("channels: 3 where 4", &|parts| parts.channels.truncate(3)),
        ("outputs: 2 where 1", &|parts| parts.tip = 0..2),
        ("outputs: 2 where 3", &|parts| parts.tip = 2..3),
        ("scaler of the inputs needs 4", &|parts| parts.inputs.spread[2] = 0.0),
        ("scaler of the targets needs 1", &|parts| parts.targets.mean.clear()),
        ("weights: ", &|parts| parts.weights.truncate(9)),
        ("max_gap is NaN", &|parts| parts.max_gap = f64::NAN),
        ("training ranges: 1 where 4", &|parts| parts.ranges = Some(vec![ChannelRange { low: 0.0, high: 1.0 }])),
        ("training range of channel 0 is 1 to 0", &|parts| {
            parts.ranges = Some(vec![ChannelRange { low: 1.0, high: 0.0 }; 4]);
        }),
    ];
    for (message, change) in cases {
        let found = refused(change);
        assert!(found.contains(message), "{found}");
    }
    assert!(refused(&|parts| parts.state = StateRule::Window(0)).contains("at least 1 sample"));
    assert!(refused(&|parts| parts.first_elapsed = 0.0).contains("first_elapsed is 0"));
}
