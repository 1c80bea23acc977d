//! Effects of one's own among the candidates: found by name where they act, and not where they do not.

use acm_core::augmented::{AugmentedModel, OnlineModel, Sample};
use acm_core::effects::own::{Own, read};
use acm_trace::finding::{Finding, FoundParameter, Verdict};
use acm_trace::trace::Options;

use crate::bench::{
    FORCE_NOISE, Recorded, closed_with, covers, effect, force, is_near, names, parameter, press_case, told,
};
use crate::effects::{heated, loose};

/// No effect of the library knows heat; the rate is not linear in the actuator.
const HEATING: &str = r#"
[[effect]]
name    = "self_heating"
meaning = "an actuator heats up under its own load, and its gain changes with the heat"
place   = "actuators"
unit    = "rad"
rate    = { heat = "((q/full)^2 - heat)/tau" }
output  = "q*(1 + g*heat)"
[effect.constants]
full = { value = 1, unit = "rad" }
[effect.parameters]
g   = { silent = 0, bounds = [-0.9, 0.9], guesses = [-0.3, -0.1, 0.1, 0.3] }
tau = { unit = "s", bounds = [0.1, 20], guesses = [0.5, 1.5, 5] }
"#;

fn options(recorded: &Recorded) -> Options {
    let definitions = read(HEATING, "my_effects.toml").unwrap();
    let own = definitions.iter().map(|one| Own::new(one, &recorded.case.rig).unwrap());
    Options { own: own.collect(), ..Options::default() }
}

/// Oracle: the planted values, simulated by a formula of the test's own, within the width of the 95 % interval: the effect takes
/// signals as linear between samples, which the truth's are not. The saved model holds the definition, and streams the
/// bits of whole trials.
#[test]
fn an_effect_that_the_library_lacks_is_found_by_name() {
    let (gain, tau) = (-0.25, 2.0);
    let recorded = press_case(5, |drive| {
        let q = heated(&drive.time, &drive.motion[0], gain, tau);
        q.into_iter().map(force).collect()
    });
    let (options, trial) = (options(&recorded), recorded.case.development[0].record.clone());
    let closed = closed_with(recorded, &options);
    let finding = &closed.finding;
    assert_eq!((names(finding), finding.verdict), (vec!["self_heating"], Verdict::Named), "{}", told(finding));
    let found = effect(finding, "self_heating");
    assert!(found.source.contains("my_effects.toml") && found.meaning.contains("its own load"));
    for (name, planted) in [("g", gain), ("tau", tau)] {
        let FoundParameter { value, interval: [low, high], .. } = parameter(found, name);
        assert!((value - planted).abs() < high - low, "{name}: {:?}", found.parameters);
    }
    assert!(parameter(found, "tau").interval[1] < 2.0 * tau, "{:?}", found.parameters);
    assert!(is_near(finding, FORCE_NOISE), "{}", told(finding));
    assert!(finding.sentence.contains("self heating"), "{}", finding.sentence);

    let text = serde_json::to_string(&closed.model).unwrap();
    assert!(text.contains("((q/full)^2 - heat)/tau"));
    let model: AugmentedModel = serde_json::from_str(&text).unwrap();
    let whole = closed.model.predict(&trial, None);
    assert_eq!(model.predict(&trial, None), whole);
    let mut stream = OnlineModel::new(&model).unwrap();
    for t in 0..trial.samples() {
        let mut out = [0.0];
        let actuators = [trial.actuators[0][t]];
        let (contexts, acceleration, predicted) = (&[][..], &[][..], &[][..]);
        let sample = Sample { time: trial.time[t], actuators: &actuators, contexts, acceleration, predicted };
        stream.step(&sample, &mut out);
        assert_eq!(out[0].to_bits(), whole[(t, 0)].to_bits(), "sample {t}");
    }
}

#[test]
fn where_it_does_not_act_it_is_not_found() {
    let recorded = press_case(2, |drive| {
        let q = loose(&drive.time, &drive.motion[0], 0.08);
        q.into_iter().map(force).collect()
    });
    let finding = closed_with(recorded, &Options::default()).finding;
    let with_own = press_case(2, |drive| {
        let q = loose(&drive.time, &drive.motion[0], 0.08);
        q.into_iter().map(force).collect()
    });
    let options = options(&with_own);
    let beside = closed_with(with_own, &options).finding;
    assert_eq!(names(&beside), ["backlash"], "{}", told(&beside));
    // Intervals span the candidates that predict as well, of which it is one more.
    let width = |finding: &Finding| parameter(effect(finding, "backlash"), "width_q1").clone();
    let (with, plain) = (width(&beside), width(&finding));
    assert_eq!(with.value, plain.value);
    assert!(covers(&with, 0.08) && covers(&plain, 0.08), "{with:?} {plain:?}");
    let without = Options { without: vec!["self_heating".into()], ..options };
    let recorded = press_case(2, |drive| drive.q()[0].iter().map(|q| force(*q)).collect());
    let left = closed_with(recorded, &without).finding.left;
    let own = left.not_tried.iter().find(|one| one.name == "self_heating").unwrap();
    assert!(own.reason.contains("left out by the configuration"), "{}", own.reason);
}
