//! Two effects at once, and one that is not in the library.

use acm_trace::finding::{Finding, Verdict};
use acm_trace::trace::Options;

use crate::bench::{
    Recorded, arm_case, closed_with, covers, effect, force, found, names, parameter, press_case, tips, told,
};
use crate::effects::{creeping, loose_and_creeping};
use crate::motion::Motion;

#[test]
fn backlash_and_creep_are_both_found() {
    let both = |time: &[f64], motion: &Motion| loose_and_creeping(time, motion, 0.06, 0.25, 4.0);
    let finding = found(arm_case(11, |drive| tips(&drive.after(both))));
    let mut names = names(&finding);
    names.sort_unstable();
    assert_eq!(names, ["backlash", "creep"], "{}", told(&finding));
    assert!(matches!(finding.verdict, Verdict::Named | Verdict::FormImperfect), "{}", told(&finding));
}

fn creep(seed: u64) -> Recorded {
    arm_case(seed, |drive| tips(&drive.after(|time, motion| creeping(time, motion, 0.3, 4.0))))
}

#[test]
fn creep_is_named() {
    let finding = found(creep(12));
    assert_eq!((finding.verdict, names(&finding)), (Verdict::Named, vec!["creep"]), "{}", told(&finding));
    let creep = effect(&finding, "creep");
    for (name, truth) in [("share", 0.3), ("tau", 4.0)] {
        let parameter = parameter(creep, name);
        assert!(covers(parameter, truth) && (parameter.value / truth - 1.0).abs() < 0.05, "{parameter:?}");
    }
}

/// One actuator and a force: nothing else passes for creep.
#[test]
fn creep_is_not_named_where_the_library_lacks_it() {
    let case = press_case(12, |drive| {
        drive.after(|time, motion| creeping(time, motion, 0.3, 4.0))[0].iter().map(|q| force(*q)).collect()
    });
    let finding = without_creep(case);
    assert!(finding.left.not_tried.iter().any(|effect| effect.name == "creep"));
    assert_ne!(finding.verdict, Verdict::Named, "{}", told(&finding));
}

#[test]
fn creep_of_an_arm_is_not_named_where_the_library_lacks_it() {
    let finding = without_creep(creep(12));
    assert_ne!(finding.verdict, Verdict::Named, "{}", told(&finding));
}

fn without_creep(case: Recorded) -> Finding {
    closed_with(case, &Options { without: vec!["creep".into()], ..Options::default() }).finding
}
