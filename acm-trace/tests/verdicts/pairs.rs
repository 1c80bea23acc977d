//! Two effects at once, and one that is not in the library.

use acm_trace::finding::Verdict;
use acm_trace::trace::Options;

use crate::bench::{arm_case, closed_with, found, names, tips, told};
use crate::effects::{creeping, loose};
use crate::motion::Motion;

#[test]
fn backlash_and_creep_are_both_found() {
    // The play follows the drive, and what it moves creeps.
    let both = |time: &[f64], motion: &Motion| {
        let (played, crept) = (loose(time, motion, 0.06), creeping(time, motion, 0.25, 4.0));
        let q = time.iter().map(|t| motion.at(*t));
        q.zip(played).zip(crept).map(|((q, played), crept)| played + crept - q).collect()
    };
    let finding = found(arm_case(11, |drive| tips(&drive.after(both))));
    let mut names = names(&finding);
    names.sort_unstable();
    assert_eq!(names, ["backlash", "creep"], "{}", told(&finding));
    assert!(matches!(finding.verdict, Verdict::Named | Verdict::FormImperfect), "{}", told(&finding));
}

#[test]
fn creep_is_not_named_where_the_library_lacks_it() {
    let case = || arm_case(12, |drive| tips(&drive.after(|time, motion| creeping(time, motion, 0.3, 4.0))));
    let with = found(case());
    assert_eq!((with.verdict, names(&with)), (Verdict::Named, vec!["creep"]), "{}", told(&with));
    let options = Options { without: vec!["creep".into()], ..Options::default() };
    let without = closed_with(case(), &options).finding;
    assert_ne!(without.verdict, Verdict::Named, "{}", told(&without));
    assert!(without.left.not_tried.iter().any(|effect| effect.name == "creep"));
}
