//! Made-up findings of each verdict, in millimetres.

use acm_core::effects::Site;
use acm_trace::finding::{
    Baselines, Confirmation, Errors, Estimate, Event, Figures, Finding, Left, NetworkRow, NotTried, Probe, Symbolic,
    SymbolicTerm, Verdict,
};

use super::parts::{carrier, correlation, data, effect, figures, lengths, parameter, step};

/// Play in the first actuator: 23 mm before, 2.65 mm after.
pub fn named_in_mm() -> Finding {
    let error = |value, low, high| Estimate { value, interval: [low, high] };
    let first = parameter("width_q1", 0.05236, [0.0511, 0.0537], "rad");
    let second = parameter("width_q2", 0.0007, [-0.0004, 0.0018], "rad");
    let tried = vec![("backlash", 2.66), ("prandtl_ishlinskii", 2.67), ("dead_time", 7.9)];
    Finding {
        format: 2,
        sentence: "The arm has backlash in its first actuator (3.0° of play): with it in the model, the error on \
                   held-out trials falls from 8.71 to 2.65 mm, and nothing but noise is left."
            .into(),
        verdict: Verdict::Named,
        effects: vec![effect("backlash", Site::Actuation, vec![first, second])],
        equivalent: vec!["backlash".into(), "prandtl_ishlinskii".into()],
        clock_correction: None,
        zero_order_hold: vec![],
        quartic_interpolation: vec![],
        before: vec![],
        trial_offset: None,
        errors: Errors {
            unit: "m".into(),
            noise: 2.6,
            baselines: Baselines {
                nominal: error(23.3, 20.9, 25.8),
                static_map: error(11.2, 9.6, 12.9),
                recalibrated: error(8.71, 7.6, 9.9),
            },
            after: error(2.65, 2.59, 2.72),
            after_without_offsets: None,
            change: error(-68.8, -90.1, -50.2),
        },
        removed: Some(0.996),
        confirmation: Confirmation::Confirmed,
        steps: vec![
            step("nominal", 23.4, None, vec![]),
            step("+ backlash", 2.66, Some(14.2), tried),
            step("+ actuator_lag", 2.66, Some(0.3), vec![("actuator_lag", 2.66), ("creep", 2.665)]),
        ],
        left: Left {
            rms: 0.31,
            probe: Some(Probe { explained: 0.012, by_chance: 0.021, p: 0.34, rms: 0.05 }),
            network: None,
            events: vec![],
            autocorrelation: correlation(0.6, 0.01),
            not_tried: vec![
                NotTried { name: "downwash".into(), reason: "needs a throttle signal".into() },
                NotTried { name: "ground_effect".into(), reason: "needs a throttle signal".into() },
                NotTried { name: "tip_load".into(), reason: "needs payload metadata".into() },
            ],
        },
        symbolic: None,
        minor: vec![],
        next_experiment: Some(
            "Reverse the first actuator at several amplitudes between 2° and 10°: play is the same at each, the loops \
             of Prandtl–Ishlinskii shrink."
                .into(),
        ),
        cautions: vec!["Only two trials are held out, so the interval of the error is coarse.".into()],
        networks: vec![],
        figures: figures("backlash", "q1", "x", 0.02),
        data: data("made-up-arm", true),
        seconds: 6.3,
        configuration: serde_json::json!({ "seed": 7, "bootstrap": 1000, "effects": "all" }),
        version: "0.2.0".into(),
    }
}

/// Clear, and not quite of the form in the library; with networks on top.
pub fn form_imperfect_in_mm() -> Finding {
    let network = |model: &str, error, sd| NetworkRow { model: model.into(), error, sd };
    Finding {
        sentence:
            "The arm has backlash in its first actuator, of a form that the library does not quite have (1.4 mm left)."
                .into(),
        verdict: Verdict::FormImperfect,
        errors: lengths([23.3, 11.2, 8.7], 2.98),
        removed: Some(0.968),
        networks: vec![
            network("nominal", 23.3, None),
            network("nominal + effect", 2.98, None),
            network("nominal + network", 4.52, Some(0.21)),
            network("nominal + effect + network", 2.71, Some(0.04)),
        ],
        figures: figures("backlash", "q1", "x", 0.15),
        ..named_in_mm()
    }
}

/// Two effects, with something else beside them.
pub fn partial_in_mm() -> Finding {
    let lag = parameter("time_constant", 0.2204, [0.2133, 0.2275], "s");
    let offset = parameter("offset_x", -0.00423, [-0.0061, -0.0024], "m");
    Finding {
        sentence: "A lag of the actuators explains a part of the error (8.7 to 5.9 mm); the rest has another cause."
            .into(),
        verdict: Verdict::Partial,
        effects: vec![
            effect("actuator_lag", Site::Actuation, vec![lag]),
            effect("marker_offset", Site::Marker, vec![offset]),
        ],
        equivalent: vec!["actuator_lag".into(), "measurement_lag".into(), "dead_time".into()],
        errors: lengths([23.3, 11.2, 8.7], 5.9),
        removed: Some(0.593),
        left: Left {
            rms: 5.3,
            probe: Some(Probe { explained: 0.41, by_chance: 0.019, p: 0.0, rms: 3.4 }),
            autocorrelation: correlation(0.6, 0.4),
            ..named_in_mm().left
        },
        figures: Figures {
            carriers: vec![
                carrier("actuator_lag", "rate of q1", "rad/s", "x", 0.6),
                carrier("marker_offset", "time", "s", "z", 0.9),
            ],
            ..figures("actuator_lag", "q1", "x", 0.6)
        },
        data: data("made-up-arm", false),
        ..named_in_mm()
    }
}

/// Noise alone.
pub fn no_effect_in_mm() -> Finding {
    Finding {
        sentence:
            "Nothing that the model lacks can be seen: its error on held-out trials, 2.63 mm, is that of the noise."
                .into(),
        verdict: Verdict::NoEffect,
        effects: vec![],
        equivalent: vec![],
        errors: lengths([2.71, 2.66, 2.63], 2.63),
        confirmation: Confirmation::NotTested,
        removed: None,
        steps: vec![step("nominal", 2.71, None, vec![])],
        left: Left { rms: 0.1, autocorrelation: correlation(0.02, 0.02), ..named_in_mm().left },
        minor: vec![],
        next_experiment: None,
        cautions: vec![],
        figures: figures("", "q1", "x", 1.0),
        ..named_in_mm()
    }
}

/// A product of coordinates that no effect has.
pub fn unknown_structure_in_mm() -> Finding {
    let term = |on: &str, term: &str, coefficient| SymbolicTerm { on: on.into(), term: term.into(), coefficient };
    Finding {
        sentence:
            "The inputs predict what the model misses, but no known effect does; Δq1 = −0.090·q1·q2 describes it."
                .into(),
        verdict: Verdict::UnknownStructure,
        effects: vec![],
        equivalent: vec![],
        errors: lengths([14.1, 12.9, 12.2], 12.2),
        confirmation: Confirmation::NotTested,
        removed: Some(0.0),
        left: Left {
            rms: 11.9,
            probe: Some(Probe { explained: 0.83, by_chance: 0.02, p: 0.0, rms: 10.9 }),
            autocorrelation: correlation(0.7, 0.7),
            ..named_in_mm().left
        },
        symbolic: Some(Symbolic {
            formula: "Δq1 = −0.090·q1·q2 + 0.004·q2²".into(),
            error: 2.9,
            terms: vec![term("Δq1", "q1·q2", -0.0903), term("Δq1", "q2²", 0.004)],
        }),
        minor: vec![],
        next_experiment: Some(
            "Hold q2 and move q1, then the other way round: the product vanishes where one of them is zero.".into(),
        ),
        figures: figures("", "q1", "x", 1.0),
        ..named_in_mm()
    }
}

/// A slip in one trial.
pub fn event_in_mm() -> Finding {
    let happened = |kind: &str, share, what: &str| Event { kind: kind.into(), share, what: what.into() };
    Finding {
        sentence: "Something slipped in trial 17 at 42.3 s (9 mm in x); apart from that nothing is missing.".into(),
        verdict: Verdict::Event,
        effects: vec![],
        equivalent: vec![],
        errors: lengths([6.4, 6.2, 6.1], 6.1),
        confirmation: Confirmation::NotTested,
        removed: None,
        left: Left {
            rms: 5.5,
            events: vec![
                happened("slip", 0.91, "trial 17, at 42.3 s: the output x jumps by 9.1 mm and does not come back"),
                happened("spectral line", 0.04, "all trials: 7.2 Hz in z, 0.8 mm"),
            ],
            autocorrelation: correlation(0.8, 0.8),
            ..named_in_mm().left
        },
        figures: figures("", "q1", "x", 1.0),
        ..named_in_mm()
    }
}

/// Wind, perhaps.
pub fn unmeasured_in_mm() -> Finding {
    Finding {
        sentence:
            "What is left lasts for seconds and nothing recorded predicts it: something acted that was not measured."
                .into(),
        verdict: Verdict::UnmeasuredDisturbance,
        effects: vec![],
        equivalent: vec![],
        errors: lengths([7.4, 7.2, 7.1], 7.1),
        confirmation: Confirmation::NotTested,
        removed: None,
        left: Left {
            rms: 6.6,
            probe: Some(Probe { explained: -0.03, by_chance: 0.03, p: 0.81, rms: 0.0 }),
            autocorrelation: correlation(0.9, 0.9),
            ..named_in_mm().left
        },
        figures: figures("", "q1", "x", 1.0),
        ..named_in_mm()
    }
}
