//! One planted truth for each verdict, on an arm of two actuators.

use acm_trace::finding::{Level, Verdict};

use crate::bench::{NOISE, arm_case, covers, effect, found, is_near, names, parameter, tips, told};
use crate::effects::{delayed, soft};
use crate::motion::{random, walk, wandering};

#[test]
fn white_noise_lacks_nothing() {
    let finding = found(arm_case(1, |drive| tips(&drive.q())));
    assert_eq!(finding.verdict, Verdict::NoEffect, "{}", told(&finding));
    assert!(finding.effects.is_empty() && finding.symbolic.is_none());
    // Of three coordinates together.
    let noise = NOISE * 3f64.sqrt();
    assert!((finding.errors.noise / noise - 1.0).abs() < 0.05, "{}", finding.errors.noise);
}

#[test]
fn a_dead_time_is_named_with_its_delay() {
    let finding = found(arm_case(2, |drive| tips(&drive.after(|time, motion| delayed(time, motion, 0.2)))));
    assert_eq!((finding.verdict, names(&finding)), (Verdict::Named, vec!["dead_time"]), "{}", told(&finding));
    let delay = parameter(effect(&finding, "dead_time"), "delay");
    assert!(covers(delay, 0.2) && (delay.value - 0.2).abs() < 0.01, "{delay:?}");
    assert!(finding.removed.is_some_and(|removed| removed > 0.98), "{}", told(&finding));
    assert!(is_near(&finding, NOISE * 3f64.sqrt()), "{}", told(&finding));
}

/// Three plays of different width are what several hysteresis forms describe, alone or one behind the other.
#[test]
fn a_soft_play_is_named_as_plays_of_its_width() {
    let finding = found(arm_case(3, |drive| tips(&drive.after(|time, motion| soft(time, motion, 0.08)))));
    assert!(matches!(finding.verdict, Verdict::Named | Verdict::FormImperfect), "{}", told(&finding));
    let width = |name: &&str| match *name {
        "backlash" => parameter(effect(&finding, name), "width_q1").value,
        "bouc_wen" => parameter(effect(&finding, name), "opening_q1").value,
        _ => panic!("{}", told(&finding)),
    };
    let widths: f64 = names(&finding).iter().map(width).sum();
    assert!((widths / 0.08 - 1.0).abs() < 0.2, "{widths}: {}", told(&finding));
}

/// A dead time, and a tip that wanders as far on its own.
#[test]
fn what_is_only_a_part_is_not_the_whole() {
    let finding = found(arm_case(4, |drive| {
        let mut y = tips(&drive.after(|time, motion| delayed(time, motion, 0.2)));
        let mut random = random(drive.seed + 5);
        for column in &mut y {
            let walk = walk(&mut random, column.len(), 0.8 * NOISE);
            column.iter_mut().zip(walk).for_each(|(y, walk)| *y += walk);
        }
        y
    }));
    assert!(
        !matches!(finding.verdict, Verdict::Named | Verdict::FormImperfect | Verdict::NoEffect),
        "{}",
        told(&finding)
    );
    assert!(finding.effects.iter().all(|effect| effect.equivalent.contains(&"dead_time".into())), "{}", told(&finding));
}

/// A product of two actuators, in the development trials alone: static, so that a correction of the nominal model takes it up.
#[test]
fn a_product_of_two_actuators_is_taken_up_by_the_correction_and_has_no_name() {
    let finding = found(arm_case(5, |drive| {
        let q = drive.q();
        let first = q[0].iter().zip(&q[1]).map(|(a, b)| a - 0.09 * a * b).collect();
        tips(&[first, q[1].clone()])
    }));
    assert!(names(&finding).is_empty(), "{}", told(&finding));
    let baselines = &finding.errors.baselines;
    assert!(baselines.recalibrated.value < 0.6 * baselines.nominal.value, "{}", told(&finding));
    assert!(finding.errors.after.value < 1.02 * baselines.recalibrated.value, "{}", told(&finding));
}

/// A rate squared, which no library has: Δq1 = 0.3 (dq1/dt)².
#[test]
fn a_rate_squared_has_a_formula_and_no_sure_name() {
    let finding = found(arm_case(5, |drive| {
        let q = drive.q();
        let h = 1e-4;
        let rate = |t: &f64| (drive.motion[0].at(t + h) - drive.motion[0].at(t - h)) / (2.0 * h);
        let first = q[0].iter().zip(&drive.time).map(|(q, t)| q + 0.3 * rate(t).powi(2)).collect();
        tips(&[first, q[1].clone()])
    }));
    assert_eq!(finding.verdict, Verdict::UnknownStructure, "{}", told(&finding));
    assert!(finding.effects.iter().all(|effect| effect.confidence.level < Level::Sure), "{}", told(&finding));
    let symbolic = finding.symbolic.as_ref().unwrap_or_else(|| panic!("no formula: {}", told(&finding)));
    let term = symbolic.terms.iter().find(|term| term.on == "Δq1" && term.term == "(dq1/dt)²");
    let term = term.unwrap_or_else(|| panic!("not on Δq1: {}", symbolic.formula));
    assert!((term.coefficient / 0.3 - 1.0).abs() < 0.15, "{}", symbolic.formula);
}

#[test]
fn a_slip_is_an_event() {
    let finding = found(arm_case(6, |drive| {
        let mut q = drive.q();
        if drive.index == 3 {
            q[1].iter_mut().zip(&drive.time).filter(|(_, time)| **time >= 11.0).for_each(|(q, _)| *q += 0.15);
        }
        tips(&q)
    }));
    assert_eq!(finding.verdict, Verdict::Event, "{}", told(&finding));
    assert!(names(&finding).is_empty(), "{}", told(&finding));
    let event = &finding.left.events[0];
    assert_eq!(event.kind, "slip");
    assert!(event.what.contains("q2") && event.what.contains("d3"), "{}", event.what);
}

#[test]
fn what_no_signal_carries_is_a_disturbance() {
    let finding = found(arm_case(7, |drive| {
        let mut random = random(drive.seed + 9);
        let mut y = tips(&drive.q());
        for column in &mut y {
            let wander = wandering(&mut random, column.len(), 0.1, 6.0 * NOISE, 1.5);
            column.iter_mut().zip(wander).for_each(|(y, wander)| *y += wander);
        }
        y
    }));
    assert_eq!(finding.verdict, Verdict::UnmeasuredDisturbance, "{}", told(&finding));
    assert!(names(&finding).is_empty(), "{}", told(&finding));
    assert!(finding.next_experiment.is_some_and(|next| next.contains("repeat")));
}
