//! Two effects at once, and one that is not in the library.

use acm_trace::finding::{Finding, Verdict};
use acm_trace::trace::Options;

use crate::bench::{
    Recorded, arm, arm_case, closed_with, covers, effect, force, found, names, parameter, press_case, tips, told,
};
use crate::effects::{creeping, delayed, loose, loose_and_creeping};
use crate::motion::{Motion, normal, random};

#[test]
fn backlash_and_creep_are_both_found() {
    let both = |time: &[f64], motion: &Motion| loose_and_creeping(time, motion, 0.06, 0.25, 4.0);
    let finding = found(arm_case(11, |drive| tips(&drive.after(both))));
    let mut names = names(&finding);
    names.sort_unstable();
    assert_eq!(names, ["backlash", "creep"], "{}", told(&finding));
    assert!(matches!(finding.verdict, Verdict::Named | Verdict::FormImperfect), "{}", told(&finding));
}

/// The play was there when the nominal model was calibrated, on trials that move; the delay came with the development trials.
#[test]
fn each_effect_tells_whether_it_acts_in_calibration() {
    let bench = arm();
    let trial = |part: &str, k: usize, delay: f64| {
        let drive = bench.drive(k, 250, 13, &[]);
        let q = drive.after(|time, motion| loose(&time.iter().map(|t| t - delay).collect::<Vec<f64>>(), motion, 0.1));
        bench.trial(part, &drive, &tips(&q))
    };
    let of = |part: &str, range: std::ops::Range<usize>, delay: f64| range.map(|k| trial(part, k, delay)).collect();
    let finding = found(bench.case(of("c", 0..4, 0.0), of("d", 4..10, 0.25), of("u", 10..12, 0.25)));
    let mut names = names(&finding);
    names.sort_unstable();
    assert_eq!(names, ["backlash", "dead_time"], "{}", told(&finding));
    let since = |name: &str| effect(&finding, name).in_calibration;
    assert_eq!((since("backlash"), since("dead_time")), (Some(true), Some(false)));
    assert!(covers(parameter(effect(&finding, "dead_time"), "delay"), 0.25), "{}", told(&finding));
}

/// Offsets of the trials are fifty times the noise, and five times what the delay moves.
#[test]
fn a_dead_time_is_found_under_the_offsets_of_trials() {
    let finding = found(press_case(14, |drive| {
        let offset = 2.5 * normal(&mut random(drive.seed + 9));
        drive.after(|time, motion| delayed(time, motion, 0.2))[0].iter().map(|q| force(*q) + offset).collect()
    }));
    assert_eq!(names(&finding), ["dead_time"], "{}", told(&finding));
    let delay = parameter(effect(&finding, "dead_time"), "delay");
    assert!(covers(delay, 0.2) && (delay.value - 0.2).abs() < 0.01, "{delay:?}");
    assert!(finding.trial_offset.is_some(), "{}", told(&finding));
}

/// Half as long as a trial of 25 s.
#[test]
fn creep_may_last_as_long_as_a_trial() {
    let finding = found(press_case(15, |drive| {
        drive.after(|time, motion| creeping(time, motion, 0.4, 12.0))[0].iter().map(|q| force(*q)).collect()
    }));
    let tau = parameter(effect(&finding, "creep"), "tau");
    assert!((tau.value / 12.0 - 1.0).abs() < 0.15, "{tau:?}: {}", told(&finding));
}

/// Two Kelvin–Voigt elements in series with a spring: the creep of each adds up, and no single time explains both.
#[test]
fn a_creep_of_two_times_is_found() {
    let finding = found(press_case(16, |drive| {
        let two = |time: &[f64], motion: &Motion| -> Vec<f64> {
            let parts = [(0.3, 0.6), (0.25, 7.0)].map(|(share, tau)| creeping(time, motion, share, tau));
            (0..time.len()).map(|t| parts[0][t] + parts[1][t] - motion.at(time[t])).collect()
        };
        drive.after(two)[0].iter().map(|q| force(*q)).collect()
    }));
    assert_eq!(names(&finding), ["creep"; 2], "{}", told(&finding));
    let mut taus: Vec<f64> = finding.effects.iter().map(|creep| parameter(creep, "tau").value).collect();
    taus.sort_by(f64::total_cmp);
    assert!((taus[0] / 0.6 - 1.0).abs() < 0.15 && (taus[1] / 7.0 - 1.0).abs() < 0.15, "{taus:?}");
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
    closed_with(case, &Options { without: vec!["creep".into(), "measurement_creep".into()], ..Options::default() })
        .finding
}
