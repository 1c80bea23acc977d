//! Made-up findings, one for each verdict and for what could break a page. FIXTURES: no robot and no simulator made
//! these numbers; they are chosen to be plausible and to be looked at.

use acm_core::effects::Site;
use acm_trace::finding::{
    Alternative, Autocorrelation, Baselines, Candidate, CarrierFigure, Confidence, Confirmation, Data, Errors,
    Estimate, Event, Figures, Finding, FoundEffect, FoundParameter, Group, Left, Level, NetworkRow, NotTried, Probe,
    Separability, Step, Symbolic, SymbolicTerm, Trace, TrialErrors, Verdict,
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

/// Play in the first actuator: 23 mm before, 2.65 mm after.
fn named_in_mm() -> Finding {
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
fn form_imperfect_in_mm() -> Finding {
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
fn partial_in_mm() -> Finding {
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
fn no_effect_in_mm() -> Finding {
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
fn unknown_structure_in_mm() -> Finding {
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
fn event_in_mm() -> Finding {
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
fn unmeasured_in_mm() -> Finding {
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

/// A cylinder: friction that grows with pressure, in newtons, on measured data.
fn newtons_in_newtons() -> Finding {
    let error = |value: f64| Estimate { value, interval: [0.93 * value, 1.08 * value] };
    let base = parameter("force", 1.82, [1.61, 2.03], "N");
    let slope = FoundParameter {
        depends_on: Some("pressure".into()),
        at_bound: false,
        undetermined: false,
        ..parameter("force per pressure", 2.31e-6, [2.14e-6, 2.48e-6], "N per Pa")
    };
    Finding {
        sentence: "The cylinder has Coulomb friction that grows with pressure: 6.09 to 1.29 N on held-out trials."
            .into(),
        verdict: Verdict::Partial,
        effects: vec![effect("coulomb_friction", Site::Output, vec![base, slope])],
        equivalent: vec!["coulomb_friction".into()],
        errors: Errors {
            unit: "N".into(),
            noise: 0.41,
            baselines: Baselines { nominal: error(6.09), static_map: error(3.4), recalibrated: error(2.2) },
            after: error(1.29),
            after_without_offsets: None,
            change: Estimate { value: -3.18, interval: [-3.9, -2.4] },
        },
        removed: Some(0.69),
        minor: vec![],
        next_experiment: None,
        figures: figures("coulomb_friction", "velocity", "force", 0.2),
        data: data("cylinder", false),
        ..named_in_mm()
    }
}

/// Three markers, five effects, sixty blocks of one record.
fn nine_outputs_in_mm() -> Finding {
    let sites = [Site::Actuation, Site::Load, Site::Marker, Site::Frame, Site::Output];
    let three = |name: &str| {
        (1..=6)
            .map(|k| parameter(&format!("{name}_q{k}"), 0.01 * f64::from(k), [0.0, 0.02 * f64::from(k)], "rad"))
            .collect()
    };
    let names = ["backlash", "tip_load", "marker_offset", "base_tilt", "measurement_lag"];
    let carriers =
        names.iter().enumerate().map(|(k, name)| carrier(name, &format!("q{}", k + 1), "rad", "z of marker 3", 0.1));
    let trial = |k: usize| TrialErrors {
        name: format!("block {k}"),
        nominal: 20.0 + weyl(k),
        best_baseline: 9.0 + weyl(k),
        after: 2.7 + 8.0 * weyl(7 * k).max(0.0),
    };
    let tried: Vec<(&str, f64)> = (0..30).map(|k| ("creep", 5.0 + f64::from(k))).collect();
    Finding {
        sentence: "Five effects together explain what the model misses at three markers.".into(),
        effects: names.iter().zip(sites).map(|(name, site)| effect(name, site, three(name))).collect(),
        equivalent: names.map(String::from).to_vec(),
        steps: names.iter().map(|name| step(&format!("+ {name}"), 5.0, Some(3.0), tried.clone())).collect(),
        cautions: (1..9).map(|k| format!("Number {k}: {CAUTION}")).collect(),
        figures: Figures {
            carriers: carriers.collect(),
            trials: (0..60).map(trial).collect(),
            ..named_in_mm().figures
        },
        ..named_in_mm()
    }
}

const CAUTION: &str = "the record was cut into blocks, which are not independent of each other, so that every interval \
    is too narrow.";

/// Names that are long, and that HTML or the plotting library could take for their own.
fn long_names_in_mm() -> Finding {
    let long = format!("<script>alert(1)</script>&\"'$x^2$ {}", "a_name_without_any_space_".repeat(12));
    let mut finding = form_imperfect_in_mm();
    finding.sentence = long.clone();
    finding.equivalent = vec![long.clone(), format!("{long}2")];
    for effect in &mut finding.effects {
        (effect.name, effect.meaning, effect.source) = (long.clone(), long.clone(), long.clone());
        effect.carrier = Some(long.clone());
        effect
            .parameters
            .iter_mut()
            .for_each(|parameter| (parameter.name, parameter.unit) = (long.clone(), long.clone()));
    }
    for step in &mut finding.steps {
        step.model = long.clone();
        step.candidates.iter_mut().for_each(|candidate| candidate.name = long.clone());
    }
    finding
        .left
        .not_tried
        .iter_mut()
        .for_each(|not_tried| (not_tried.name, not_tried.reason) = (long.clone(), long.clone()));
    finding.left.events = vec![Event { kind: long.clone(), share: 0.5, what: long.clone() }];
    let term = SymbolicTerm { on: long.clone(), term: long.clone(), coefficient: 1e-9 };
    finding.symbolic = Some(Symbolic { formula: long.clone(), error: 1.0, terms: vec![term] });
    finding.networks.iter_mut().for_each(|row| row.model = long.clone());
    finding.figures.trials.iter_mut().for_each(|trial| trial.name = long.clone());
    for carrier in &mut finding.figures.carriers {
        (carrier.signal, carrier.output, carrier.effect) = (long.clone(), long.clone(), long.clone());
    }
    (finding.data.name, finding.data.title, finding.data.hash) = (long.clone(), long.clone(), long.clone());
    finding.data.held_out = vec![long.clone(); 3];
    finding.next_experiment = Some(long.clone());
    finding.cautions = vec![long];
    finding
}

/// Nothing but what must be there.
fn empty_in_mm() -> Finding {
    let mut finding = no_effect_in_mm();
    finding.sentence = String::new();
    finding.steps = vec![];
    finding.left = Left {
        rms: 0.0,
        probe: None,
        events: vec![],
        autocorrelation: Autocorrelation::default(),
        not_tried: vec![],
        network: None,
    };
    finding.figures = Figures::default();
    finding.configuration = serde_json::Value::Null;
    (finding.data.calibration, finding.data.development, finding.data.held_out) = (vec![], vec![], vec![]);
    finding
}

/// Numbers that are none, and lists that do not fit together.
fn damaged_in_mm() -> Finding {
    let none = Estimate { value: f64::NAN, interval: [f64::NAN, f64::INFINITY] };
    let mut finding = partial_in_mm();
    finding.errors = Errors {
        noise: f64::NAN,
        baselines: Baselines { nominal: none, static_map: none, recalibrated: none },
        after: none,
        after_without_offsets: Some(none),
        change: none,
        ..finding.errors
    };
    finding.removed = Some(f64::NAN);
    for effect in &mut finding.effects {
        effect.size = f64::NAN;
        effect.parameters[0].value = f64::NAN;
        effect.parameters.push(parameter("", f64::INFINITY, [f64::NEG_INFINITY, f64::INFINITY], ""));
    }
    finding.figures.carriers[0].before = vec![f64::NAN; 500];
    finding.figures.carriers[0].x.truncate(20);
    finding.figures.carriers[1].continues.clear();
    finding.figures.carriers[1].after[7] = f64::INFINITY;
    finding.figures.carriers[1].x[9] = 1e300;
    finding.figures.trials[0].after = f64::NAN;
    if let Some(trace) = &mut finding.figures.trace {
        trace.nominal = vec![];
        trace.after[3] = f64::NAN;
        trace.time[5] = f64::NAN;
    }
    finding.left.autocorrelation.after = vec![f64::NAN, 7.0];
    finding.left.autocorrelation.white = f64::NAN;
    finding.left.probe = Some(Probe { explained: f64::NAN, by_chance: f64::NAN, p: f64::NAN, rms: f64::NAN });
    finding.steps[0].error = f64::INFINITY;
    finding.seconds = f64::NAN;
    finding
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

fn parameter(name: &str, value: f64, interval: [f64; 2], unit: &str) -> FoundParameter {
    FoundParameter {
        name: name.into(),
        value,
        unit: unit.into(),
        interval,
        depends_on: None,
        at_bound: false,
        undetermined: false,
    }
}

fn effect(name: &str, site: Site, parameters: Vec<FoundParameter>) -> FoundEffect {
    FoundEffect {
        name: name.into(),
        meaning: "the tip stays behind when an actuator turns round".into(),
        site,
        carrier: Some("q1".into()),
        parameters,
        size: 8.3,
        removes: 0.0,
        confidence: Confidence { level: Level::Sure, share: 0.97 },
        doubts: vec![],
        follows: None,
        equivalent: vec![name.into()],
        alternatives: vec![
            Alternative { name: format!("{name}(q1)"), share: 0.97 },
            Alternative { name: "creep(q2)".into(), share: 0.02 },
            Alternative { name: String::new(), share: 0.01 },
        ],
        in_calibration: Some(true),
        source: "A made-up source, 1957".into(),
    }
}

fn step(model: &str, error: f64, significance: Option<f64>, candidates: Vec<(&str, f64)>) -> Step {
    let candidate = |(name, error): (&str, f64)| Candidate { name: name.into(), error };
    Step {
        model: model.into(),
        error,
        significance,
        gain: significance.map(|_| 0.87),
        by_chance: significance.map(|_| 0.021),
        accepted: significance.is_none_or(|t| t > 2.0),
        candidates: candidates.into_iter().map(candidate).collect(),
    }
}

fn lengths([nominal, static_map, recalibrated]: [f64; 3], after: f64) -> Errors {
    let error = |value: f64| Estimate { value, interval: [0.92 * value, 1.1 * value] };
    let baselines =
        Baselines { nominal: error(nominal), static_map: error(static_map), recalibrated: error(recalibrated) };
    let change = after * after - recalibrated * recalibrated;
    let change = Estimate { value: change, interval: [change - 9.0, change + 9.0] };
    let unit = "m".into();
    Errors { unit, noise: 2.6, baselines, after: error(after), after_without_offsets: None, change }
}

fn data(name: &str, synthetic: bool) -> Data {
    let names = |numbers: std::ops::Range<usize>| numbers.map(|n| n.to_string()).collect();
    Data {
        name: name.into(),
        title: "A made-up campaign, to look at pages with".into(),
        hash: "0f1e2d3c4b5a69788796a5b4c3d2e1f00f1e2d3c4b5a69788796a5b4c3d2e1f0".into(),
        synthetic,
        calibration: names(1..5),
        development: names(5..16),
        held_out: names(16..18),
    }
}

/// A number between −0.5 and 0.5 that looks like chance: the Weyl sequence of the golden ratio.
fn weyl(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_895).fract() - 0.5
}

/// A sine with play: the residual is a loop; `left` is the share of it that stays.
fn carrier(effect: &str, signal: &str, unit: &str, output: &str, left: f64) -> CarrierFigure {
    let count = 900;
    let time = |k: usize| k as f64 * 0.05;
    let x: Vec<f64> = (0..count)
        .map(|k| if signal == "time" { time(k) } else { 0.4 * (0.9 * time(k)).sin() * (0.021 * time(k)).cos() })
        .collect();
    let missed = |k: usize| 9.0 * (0.9 * time(k)).cos().signum() + 14.0 * 0.4 * (0.9 * time(k)).sin() * (1.0 - left);
    let noise = |k: usize| 4.0 * (weyl(k) + weyl(3 * k + 1));
    CarrierFigure {
        effect: effect.into(),
        signal: signal.into(),
        unit: unit.into(),
        output: output.into(),
        x,
        before: (0..count).map(|k| missed(k) + noise(k)).collect(),
        after: (0..count).map(|k| left * missed(k) + noise(k)).collect(),
        continues: (0..count).map(|k| k % 300 != 0).collect(),
    }
}

fn figures(effect: &str, signal: &str, output: &str, left: f64) -> Figures {
    let count = 600;
    let time: Vec<f64> = (0..count).map(|k| 12.0 + f64::from(k) * 0.05 + if k > 420 { 2.0 } else { 0.0 }).collect();
    let measured: Vec<f64> = time.iter().map(|t| 120.0 * (0.9 * t - 0.15).sin()).collect();
    let off = |share: f64| time.iter().zip(&measured).map(|(t, m)| m + share * 18.0 * (0.9 * t).cos()).collect();
    let trial =
        |name: &str, nominal, best_baseline, after| TrialErrors { name: name.into(), nominal, best_baseline, after };
    Figures {
        carriers: vec![carrier(effect, signal, if signal == "velocity" { "m/s" } else { "rad" }, output, left)],
        trace: Some(Trace {
            trial: "17".into(),
            output: output.into(),
            nominal: off(1.0),
            after: off(left),
            time: time.clone(),
            measured: measured.clone(),
        }),
        trials: vec![trial("16", 22.1, 8.4, 2.7 + 6.0 * left), trial("17", 24.6, 9.0, 2.6 + 7.0 * left)],
    }
}

/// A decay over half a second; `before` and `after` are how much of it there is.
fn correlation(before: f64, after: f64) -> Autocorrelation {
    let lag: Vec<f64> = (0..80).map(|k| 0.05 * f64::from(k)).collect();
    let curve = |share: f64| {
        let value = |(k, t): (usize, &f64)| {
            if k == 0 { 1.0 } else { share * (-t / 0.9).exp() * (2.1 * t).cos() + 0.03 * weyl(k) }
        };
        lag.iter().enumerate().map(value).collect()
    };
    Autocorrelation { before: curve(before), after: curve(after), lag: lag.clone(), white: 0.03 }
}
