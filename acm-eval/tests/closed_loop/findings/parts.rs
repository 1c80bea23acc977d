//! Parts of made-up findings.

use acm_core::effects::Site;
use acm_trace::finding::{
    Alternative, Autocorrelation, Baselines, Candidate, CarrierFigure, Confidence, Data, Errors, Estimate, Figures,
    FoundEffect, FoundParameter, Level, Step, Trace, TrialErrors,
};

pub fn parameter(name: &str, value: f64, interval: [f64; 2], unit: &str) -> FoundParameter {
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

pub fn effect(name: &str, site: Site, parameters: Vec<FoundParameter>) -> FoundEffect {
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

pub fn step(model: &str, error: f64, significance: Option<f64>, candidates: Vec<(&str, f64)>) -> Step {
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

pub fn lengths([nominal, static_map, recalibrated]: [f64; 3], after: f64) -> Errors {
    let error = |value: f64| Estimate { value, interval: [0.92 * value, 1.1 * value] };
    let baselines =
        Baselines { nominal: error(nominal), static_map: error(static_map), recalibrated: error(recalibrated) };
    let change = after * after - recalibrated * recalibrated;
    let change = Estimate { value: change, interval: [change - 9.0, change + 9.0] };
    let unit = "m".into();
    Errors { unit, noise: 2.6, baselines, after: error(after), after_without_offsets: None, change }
}

pub fn data(name: &str, synthetic: bool) -> Data {
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
pub fn weyl(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_895).fract() - 0.5
}

/// A sine with play: the residual is a loop; `left` is the share of it that stays.
pub fn carrier(effect: &str, signal: &str, unit: &str, output: &str, left: f64) -> CarrierFigure {
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

pub fn figures(effect: &str, signal: &str, output: &str, left: f64) -> Figures {
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
pub fn correlation(before: f64, after: f64) -> Autocorrelation {
    let lag: Vec<f64> = (0..80).map(|k| 0.05 * f64::from(k)).collect();
    let curve = |share: f64| {
        let value = |(k, t): (usize, &f64)| {
            if k == 0 { 1.0 } else { share * (-t / 0.9).exp() * (2.1 * t).cos() + 0.03 * weyl(k) }
        };
        lag.iter().enumerate().map(value).collect()
    };
    Autocorrelation { before: curve(before), after: curve(after), lag: lag.clone(), white: 0.03 }
}
