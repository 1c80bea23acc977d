//! Made-up findings that could break a page: other units, many outputs, long names, nothing, numbers that are none.

use acm_core::effects::Site;
use acm_trace::finding::{
    Autocorrelation, Baselines, Errors, Estimate, Event, Figures, Finding, FoundParameter, Left, Probe, Symbolic,
    SymbolicTerm, TrialErrors, Verdict,
};

use super::parts::{carrier, data, effect, figures, parameter, step, weyl};
use super::verdicts::{form_imperfect_in_mm, named_in_mm, no_effect_in_mm, partial_in_mm};

/// A cylinder: friction that grows with pressure, in newtons, on measured data.
pub fn newtons_in_newtons() -> Finding {
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
pub fn nine_outputs_in_mm() -> Finding {
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
pub fn long_names_in_mm() -> Finding {
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
pub fn empty_in_mm() -> Finding {
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
pub fn damaged_in_mm() -> Finding {
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
