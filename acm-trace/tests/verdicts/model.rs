//! The model that has what was found: saved, loaded, and the same on any number of threads.

use acm_core::augmented::AugmentedModel;
use acm_trace::case::Trial;
use acm_trace::finding::Finding;
use acm_trace::series::warm_up;
use acm_trace::trace::Options;

use crate::bench::{arm_case, closed_with, force, press_case, tips, told};
use crate::effects::{delayed, loose};

/// Root mean square of what a model leaves of some trials after the warm-up, m.
fn left(model: &AugmentedModel, trials: &[Trial]) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for trial in trials {
        let predicted = model.predict(&trial.record, None);
        let begin = warm_up(&trial.record.time);
        for (t, _) in trial.record.time.iter().enumerate().filter(|(_, time)| **time >= begin) {
            squares += (trial.measured.row(t) - predicted.row(t)).norm_squared();
            count += 1.0;
        }
    }
    f64::sqrt(squares / count)
}

/// The model that was saved, read back, leaves of held-out trials what the finding says, and of development trials about as much
/// as the search left of them when each was left out.
#[test]
fn the_saved_model_predicts_as_the_search_did() {
    let case = arm_case(31, |drive| tips(&drive.after(|time, motion| loose(time, motion, 0.08))));
    let (held_out, development) = (case.held_out.clone(), case.case.development.clone());
    let closed = closed_with(case, &Options::default());
    let text = serde_json::to_string(&closed.model).unwrap();
    let loaded: AugmentedModel = serde_json::from_str(&text).unwrap();
    assert_eq!(serde_json::to_string(&loaded).unwrap(), text);
    assert_eq!(loaded.effects().len(), 1, "{}", told(&closed.finding));
    let (error, said) = (left(&loaded, &held_out), closed.finding.errors.after.value);
    assert!((error / said - 1.0).abs() < 0.01, "{error} m where {said} m is said");
    let searched = closed.finding.steps.iter().rev().find(|step| step.accepted).unwrap().error;
    let error = left(&loaded, &development);
    assert!((0.9..1.02).contains(&(error / searched)), "{error} m where the search left {searched} m");
}

#[test]
fn no_bit_depends_on_the_number_of_threads() {
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let case = press_case(32, |drive| {
            drive.after(|time, motion| delayed(time, motion, 0.2))[0].iter().map(|q| force(*q)).collect()
        });
        let closed = pool.install(|| closed_with(case, &Options::default()));
        let finding = Finding { seconds: 0.0, ..closed.finding };
        (serde_json::to_string(&finding).unwrap(), serde_json::to_string(&closed.model).unwrap())
    };
    let (one, two) = (text(1), text(2));
    assert_eq!(one, two);
}
