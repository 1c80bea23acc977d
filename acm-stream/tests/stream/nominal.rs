//! Oracle: the model with effects on the whole trial. Effects remember across a gap, as they do in training.

use acm_core::NominalModel;
use acm_core::augmented::AugmentedModel;
use acm_core::effects::{Carrier, instance::Term};
use acm_core::record::Record;
use acm_core::rig::{Rig, Signal};
use acm_stream::{Estimator, Nominal, StateRule};

use crate::robots::{cfc, parts, polynomial, trial};

fn rig() -> Rig {
    let signal = |name: &str, low, high| Signal { name: name.into(), unit: "1".into(), low, high };
    Rig {
        actuators: vec![signal("q1", -1.0, 1.0), signal("q2", -0.6, 0.6)],
        contexts: vec![signal("temperature", 295.0, 305.0)],
        outputs: vec![signal("x", -1.0, 1.0), signal("y", -1.0, 1.0)],
        throttle: None,
        altitude: None,
        payload: None,
        carried: false,
        arm: None,
        step: 0.1,
        duration: 14.0,
    }
}

fn model() -> AugmentedModel {
    let term = |effect: &str, values: &[f64]| Term {
        effect: effect.into(),
        carrier: Carrier::Rig,
        context: None,
        values: values.to_vec(),
        definition: None,
    };
    let effects = vec![term("dead_time", &[0.25]), term("backlash", &[0.05, 0.1]), term("creep", &[0.3, 4.0])];
    let model = AugmentedModel::new(rig(), NominalModel::Polynomial(polynomial()), None, None, effects);
    model.expect("a model")
}

/// Effects forget a sample that overflowed, in the nominal model or behind it; nothing is allocated on the way.
#[test]
fn effects_forget_what_overflowed() {
    let trial = trial();
    let fresh = || {
        let mut parts = parts(cfc(4, 4), StateRule::Running);
        parts.nominal = Nominal::Augmented(model());
        Estimator::new(parts).expect("parts that fit")
    };
    let (mut clean, mut spoiled) = (fresh(), fresh());
    for (t, inputs) in trial.inputs.iter().enumerate() {
        let counted = allocation_counter::measure(|| {
            // The effects delay it: what overflows first is a channel.
            let refused = spoiled.step(&[inputs[0], 1e308, inputs[2]], 0.1).is_err();
            assert!(refused, "sample {t}");
            let found = spoiled.step(inputs, 0.1).expect("a sample")[0];
            assert_eq!(clean.step(inputs, 0.1).expect("a sample")[0], found, "sample {t}");
        });
        assert_eq!(counted.count_total, 0, "sample {t}");
    }
}

#[test]
fn effects_go_on_through_the_whole_trial() {
    let model = model();
    let trial = trial();
    let column = |j: usize| trial.inputs.iter().map(|inputs| inputs[j]).collect::<Vec<f64>>();
    let record = Record::new(trial.time.clone(), vec![column(0), column(1)], vec![column(2)], vec![]);
    let whole = model.predict(&record, None);
    let mut parts = parts(cfc(4, 4), StateRule::Running);
    parts.nominal = Nominal::Augmented(model);
    let head = parts.weights.len() - 5;
    parts.weights[head..].fill(0.0);
    let mut estimator = Estimator::new(parts).expect("parts that fit");
    let found = trial.through(&mut estimator);
    for (t, found) in found.iter().enumerate() {
        let off = (found[0] - (whole[(t, 1)] + 0.002)).abs();
        assert!(off < 1e-12, "{off:.1e} at sample {t}");
    }
    estimator.restart();
    for (t, inputs) in trial.inputs.iter().enumerate() {
        let elapsed = trial.time[t] - trial.time[t.max(1) - 1];
        let unseen = t % 3 == 1;
        let answer = if unseen { estimator.step_unseen(inputs, elapsed) } else { estimator.step(inputs, elapsed) };
        answer.expect("a sample");
        let off = (estimator.nominal()[0] - whole[(t, 1)]).abs();
        assert!(off < 1e-12, "{off:.1e} at sample {t}, effects see all samples");
    }
    let plain = polynomial().predict(&nalgebra::DMatrix::from_fn(130, 2, |t, a| trial.inputs[t][a]));
    assert!((0..130).any(|t| (plain[(t, 1)] - whole[(t, 1)]).abs() > 0.01), "the effects do something");
}

/// A clock correction would need actuators that are still to come: the estimator says what to do instead.
#[test]
fn a_clock_correction_is_refused_in_words() {
    let mut parts = parts(cfc(4, 4), StateRule::Running);
    parts.nominal = Nominal::Augmented(model().with_clock_correction(0.15));
    let Err(error) = Estimator::new(parts) else { panic!("not refused") };
    assert!(error.to_string().contains("take 0.15 s off the actuators' time stamps before streaming"), "{error}");
}
