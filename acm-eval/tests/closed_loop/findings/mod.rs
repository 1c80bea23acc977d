//! Made-up findings, one for each verdict and for what could break a page. FIXTURES: no robot and no simulator made
//! these numbers; they are chosen to be plausible and to be looked at.

mod odd;
mod parts;
mod verdicts;

use acm_trace::finding::{Baselines, Confirmation, Errors, Estimate, Finding, Group, Separability};
use odd::{damaged_in_mm, empty_in_mm, long_names_in_mm, newtons_in_newtons, nine_outputs_in_mm};
use parts::{data, lengths, parameter, weyl};
use verdicts::{
    event_in_mm, form_imperfect_in_mm, named_in_mm, no_effect_in_mm, partial_in_mm, unknown_structure_in_mm,
    unmeasured_in_mm,
};

/// Every finding, with its name.
pub fn all() -> Vec<(&'static str, Finding)> {
    vec![
        ("named", named()),
        ("form-imperfect", form_imperfect()),
        ("partial", partial()),
        ("no-effect", no_effect()),
        ("unknown-structure", unknown_structure()),
        ("event", event()),
        ("unmeasured", unmeasured()),
        ("newtons", newtons()),
        ("nine-outputs", nine_outputs()),
        ("long-names", long_names()),
        ("empty", empty()),
        ("damaged", damaged()),
        ("refuted", refuted()),
        ("clock", clock()),
    ]
}

/// Numbers of the fixtures are written in millimetres, and told in metres.
fn metres(mut finding: Finding) -> Finding {
    // A division is exact to the last digit where a factor of 0.001 is not.
    let metres = |value: &mut f64| *value /= 1e3;
    let scaled = |error: Estimate| Estimate { value: error.value / 1e3, interval: error.interval.map(|v| v / 1e3) };
    let errors = &mut finding.errors;
    let Baselines { nominal, static_map, recalibrated } = &mut errors.baselines;
    for error in
        [nominal, static_map, recalibrated, &mut errors.after].into_iter().chain(&mut errors.after_without_offsets)
    {
        *error = scaled(*error);
    }
    errors.change = scaled(scaled(errors.change));
    errors.noise /= 1e3;
    finding.effects.iter_mut().for_each(|effect| effect.size /= 1e3);
    finding.left.rms /= 1e3;
    finding.left.probe.iter_mut().for_each(|probe| probe.rms /= 1e3);
    finding.symbolic.iter_mut().for_each(|symbolic| symbolic.error /= 1e3);
    for step in &mut finding.steps {
        step.error /= 1e3;
        step.candidates.iter_mut().for_each(|candidate| candidate.error /= 1e3);
    }
    for row in &mut finding.networks {
        row.error /= 1e3;
        row.sd = row.sd.map(|sd| sd / 1e3);
    }
    let figures = &mut finding.figures;
    let trace = figures.trace.iter_mut().flat_map(|trace| [&mut trace.measured, &mut trace.nominal, &mut trace.after]);
    let carriers = figures.carriers.iter_mut().flat_map(|carrier| [&mut carrier.before, &mut carrier.after]);
    trace.chain(carriers).flatten().for_each(metres);
    for trial in &mut figures.trials {
        [&mut trial.nominal, &mut trial.best_baseline, &mut trial.after].into_iter().for_each(metres);
    }
    finding
}

/// An effect that development trials choose, and held-out trials refute: 8.7 mm become 14.2 mm.
pub fn refuted() -> Finding {
    let mut finding = Finding {
        confirmation: Confirmation::Refuted,
        removed: Some(-1.8),
        errors: lengths([23.3, 11.2, 8.7], 14.2),
        data: data("made-up-arm", false),
        ..named_in_mm()
    };
    finding.sentence = acm_trace::finding::sentence::sentence(&metres(finding.clone()));
    metres(finding)
}

/// No effect, but two clocks: stamps of the actuators are 0.85 s late.
pub fn clock() -> Finding {
    let mut finding = Finding {
        effects: vec![],
        equivalent: vec![],
        clock_correction: Some(parameter("clock_correction", 0.85, [0.83, 0.87], "s")),
        trial_offset: Some(2.1),
        errors: Errors {
            after_without_offsets: Some(Estimate { value: 2.61, interval: [2.5, 2.7] }),
            ..lengths([23.3, 11.2, 8.7], 2.9)
        },
        ..named_in_mm()
    };
    finding.trial_offset = finding.trial_offset.map(|offset| 1e-3 * offset);
    finding.sentence = acm_trace::finding::sentence::sentence(&metres(finding.clone()));
    metres(finding)
}

/// See `named_in_mm`.
pub fn named() -> Finding {
    metres(named_in_mm())
}

/// See `form_imperfect_in_mm`.
pub fn form_imperfect() -> Finding {
    metres(form_imperfect_in_mm())
}

/// See `partial_in_mm`.
pub fn partial() -> Finding {
    metres(partial_in_mm())
}

/// See `no_effect_in_mm`.
pub fn no_effect() -> Finding {
    metres(no_effect_in_mm())
}

/// See `unknown_structure_in_mm`.
pub fn unknown_structure() -> Finding {
    metres(unknown_structure_in_mm())
}

/// See `event_in_mm`.
pub fn event() -> Finding {
    metres(event_in_mm())
}

/// See `unmeasured_in_mm`.
pub fn unmeasured() -> Finding {
    metres(unmeasured_in_mm())
}

/// See `newtons_in_newtons`.
pub fn newtons() -> Finding {
    newtons_in_newtons()
}

/// See `nine_outputs_in_mm`.
pub fn nine_outputs() -> Finding {
    metres(nine_outputs_in_mm())
}

/// See `long_names_in_mm`.
pub fn long_names() -> Finding {
    metres(long_names_in_mm())
}

/// See `empty_in_mm`.
pub fn empty() -> Finding {
    metres(empty_in_mm())
}

/// See `damaged_in_mm`.
pub fn damaged() -> Finding {
    metres(damaged_in_mm())
}
/// Backlash and lag at one speed, a mocap filter, and others that are easy.
pub fn separability() -> Separability {
    let names = [
        "dead_time",
        "actuator_lag",
        "measurement_lag",
        "backlash q1",
        "backlash q2",
        "tip_load",
        "self_weight",
        "base_tilt",
        "misregistration",
    ];
    let close = |a: usize, b: usize| matches!((a.min(b), a.max(b)), (0..3, 0..3) | (5, 6) | (7, 8));
    let share = |a: usize, b: usize| match (a == b, close(a, b)) {
        (true, _) => 1.0,
        (_, true) => 0.97 - 0.03 * (a as f64 - b as f64).abs(),
        _ => 0.3 * (0.5 + weyl(17 * a + b)).abs(),
    };
    let group = |effects: &[&str], experiment: &str| Group {
        effects: effects.iter().map(ToString::to_string).collect(),
        experiment: experiment.into(),
    };
    Separability {
        format: 2,
        size: 0.01,
        unit: "m".into(),
        effects: names.map(String::from).to_vec(),
        imitated: (0..names.len()).map(|a| (0..names.len()).map(|b| share(a, b)).collect()).collect(),
        by_recalibration: vec![0.02, 0.03, 0.02, 0.11, 0.09, 0.64, 0.61, 0.93, 0.99],
        groups: vec![
            group(&names[..3], "Move each actuator at three speeds or more; only then does a delay differ from a lag."),
            group(&names[5..7], "Record one trial without and one with a known load at the tip."),
            group(&names[7..], "Turn the base by a known angle between two trials."),
        ],
        data: data("made-up-arm", true),
        version: "0.2.0".into(),
    }
}
