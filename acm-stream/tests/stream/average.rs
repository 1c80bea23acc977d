//! The mean of several estimators. Oracle: each of them alone, and arithmetic by hand.

use acm_core::NominalModel;
use acm_stream::{
    Average, AverageError, AverageParts, Estimator, MemberParts, Nominal, Parts, Signals, StateRule, StepError,
};

use super::robots::{bodies, cfc, parts, polynomial, trial};

/// A CfC over windows, a GRU that runs on and the nominal model, whose inputs stand in another order among those of a sample, with one
/// that nobody needs.
fn members() -> [MemberParts; 3] {
    let gru = bodies().remove(1);
    let signals = Signals { actuators: vec!["q1".into(), "q2".into()], contexts: vec![] };
    let nominal = Nominal::Model(NominalModel::Polynomial(polynomial()));
    let alone = Parts::alone(signals, nominal, 1..2, 0.1).expect("a nominal model");
    let member = |parts: Parts, weight: f64| MemberParts { places: [1, 3, 0][..parts.width()].to_vec(), parts, weight };
    let window = parts(cfc(8, 12), StateRule::Window(5));
    [member(window, 0.5), member(parts(gru, StateRule::Running), 0.3), member(alone, 0.2)]
}

fn average() -> AverageParts {
    AverageParts {
        inputs: ["temperature", "q1", "idle", "q2"].map(String::from).to_vec(),
        members: members().into(),
        interval: None,
    }
}

#[test]
fn the_answer_is_the_weighted_mean_of_all() {
    let trial = trial();
    let mut average = Average::new(average()).expect("parts that fit");
    let each = members().map(|one| {
        let mut estimator = Estimator::new(one.parts).expect("parts that fit");
        let width = estimator.parts().width();
        let elapsed = |t: usize| if t == 0 { 0.0 } else { trial.time[t] - trial.time[t - 1] };
        let answers = (0..trial.time.len()).map(|t| estimator.step(&trial.inputs[t][..width], elapsed(t)).unwrap()[0]);
        (answers.collect::<Vec<f64>>(), one.weight)
    });
    let nominal = &each[2].0;
    assert!(each[0].0.iter().zip(nominal).any(|(a, b)| (a - b).abs() > 1e-3), "the network adds nothing");
    for (t, [q1, q2, temperature]) in trial.inputs.iter().enumerate() {
        let elapsed = if t == 0 { 0.0 } else { trial.time[t] - trial.time[t - 1] };
        let found = average.step(&[*temperature, *q1, -7.0, *q2], elapsed).expect("a sample")[0];
        let expected: f64 = each.iter().map(|(answers, weight)| weight * answers[t]).sum();
        assert!((found - expected).abs() < 1e-15, "{found} and {expected} at {t}");
        assert!((average.nominal()[0] - nominal[t]).abs() < 1e-15);
    }
    assert_eq!((average.in_range(), average.tip().len()), (None, 1));
    average.restart();
    assert_eq!(average.history(), 0);
}

/// Outside of what the networks know, all say what their nominal models say.
#[test]
fn unseen_samples_are_the_nominal_models() {
    let mut average = Average::new(average()).expect("parts that fit");
    average.step(&[300.0, 0.1, 0.0, 0.2], 0.1).expect("a sample");
    let unseen = average.step_unseen(&[300.0, 0.3, 0.0, 0.1], 0.1).expect("a sample").to_vec();
    assert_eq!(unseen, average.nominal());
    assert_eq!(average.history(), 1);
}

#[test]
fn a_step_of_an_average_allocates_nothing() {
    let mut average = Average::new(average()).expect("parts that fit");
    let counted = allocation_counter::measure(|| {
        for k in 0..100 {
            let q = 0.01 * f64::from(k);
            assert!(average.step(&[300.0, q, 0.0, -q], 0.1).is_ok());
            assert!(average.step(&[300.0, f64::NAN, 0.0, -q], 0.1).is_err());
            assert!(average.step_unseen(&[300.0, q, 0.0, -q], 0.1).is_ok());
        }
        average.restart();
    });
    assert_eq!(counted.count_total, 0);
}

/// A refused sample changes nothing.
#[test]
fn a_sample_that_cannot_be_taken_leaves_all_as_they_were() {
    let (mut clean, mut spoilt) = (Average::new(average()).unwrap(), Average::new(average()).unwrap());
    for k in 0..20 {
        let sample = [300.0, 0.05 * f64::from(k), 0.0, 0.1];
        assert_eq!(spoilt.step(&sample[..3], 0.1), Err(StepError::Count { found: 3, needed: 4 }));
        assert!(matches!(
            spoilt.step(&[300.0, 0.0, f64::INFINITY, 0.0], 0.1),
            Err(StepError::NotFinite { index: 2, .. })
        ));
        if k > 0 {
            assert!(matches!(spoilt.step(&sample, -0.1), Err(StepError::Elapsed { .. })));
        }
        assert_eq!(clean.step(&sample, 0.1).unwrap(), spoilt.step(&sample, 0.1).unwrap());
    }
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut AverageParts)| {
        let mut parts = average();
        change(&mut parts);
        Average::new(parts).map(drop).unwrap_err()
    };
    assert_eq!(refused(&|parts| parts.members.clear()), AverageError::Empty);
    assert_eq!(
        refused(&|parts| parts.members[1].places[0] = 4),
        AverageError::Member { member: 1, what: "its inputs" }
    );
    assert_eq!(
        refused(&|parts| {
            parts.members[0].places.pop();
        }),
        AverageError::Member { member: 0, what: "its inputs" }
    );
    assert!(matches!(refused(&|parts| parts.members[0].weight = 0.6), AverageError::Weights { .. }));
    assert!(matches!(
        refused(&|parts| {
            parts.members[0].parts.weights.pop();
        }),
        AverageError::Parts(_)
    ));
}

#[test]
fn a_file_gives_the_same_bits_and_a_changed_one_nothing() {
    let bytes = average().to_json().expect("finite numbers");
    let read = Average::new(AverageParts::from_json(&bytes).expect("what was written")).expect("parts that fit");
    let (mut read, mut made) = (read, Average::new(average()).unwrap());
    for k in 0..20 {
        let sample = [300.0, 0.05 * f64::from(k), 0.0, 0.1];
        assert_eq!(read.step(&sample, 0.1).unwrap()[0].to_bits(), made.step(&sample, 0.1).unwrap()[0].to_bits());
    }
    let text = String::from_utf8(bytes).unwrap();
    assert!(AverageParts::from_json(text.replacen("0.5", "0.6", 1).as_bytes()).is_err());
    assert!(Parts::from_json(&average().to_json().unwrap()).is_err(), "an average is no single estimator");
}
