//! Closing the loop: from a case to a finding and the completed model.

use acm_core::InterSample;
use acm_core::augmented::AugmentedModel;
use acm_core::calibration::CalibrationError;
use acm_core::effects::Effect;
use acm_core::effects::own::Own;

use crate::agreement::agrees;
use crate::case::{Case, Trial};
use crate::covered::extrapolated;
use crate::diagnose::autocorrelation::autocorrelation;
use crate::diagnose::events::events;
use crate::diagnose::probe::probe;
use crate::diagnose::recurrent::recurrent;
use crate::diagnose::residuals::{LeftOut, left_out};
use crate::diagnose::symbolic::symbolic;
use crate::finding::clocks::widened;
use crate::finding::experiment::to_separate;
use crate::finding::figures::figures;
use crate::finding::found::{Found, downgraded, found};
use crate::finding::sentence;
use crate::finding::verdict::{AtBound, Evidence};
use crate::finding::{
    Autocorrelation, BeforeForm, BeforeTrial, Data, Finding, FoundEffect, Left, NotTried, Step, Verdict,
};
use crate::fit::state::modes;
use crate::holdout::{Holdout, Measure};
use crate::prepared::{self, Prepared};
use crate::search::select::sum;
use crate::series::before::Before;
use crate::series::{Series, number_blocks};
use crate::trace::{self, Options, Traced};

/// Facts about a case that the finding repeats.
#[derive(Debug, Clone)]
pub struct About {
    /// Description of the data; names of trials are filled in.
    pub data: Data,
    /// Configuration as resolved.
    pub configuration: serde_json::Value,
    /// Version of the program.
    pub version: String,
    /// Caveats that weaken the conclusion.
    pub cautions: Vec<String>,
    /// Half of the 95 % interval of the offset between the clocks of actuators and outputs, s; 0 with one clock or a given offset.
    pub clock_interval: f64,
}

/// A finding, and the model with what was found.
#[derive(Debug, Clone)]
pub struct Closed {
    /// Result that is written to `loop.json`.
    pub finding: Finding,
    /// Completed model.
    pub model: AugmentedModel,
}

/// Finds what the nominal model of a case lacks, adds it, and predicts held-out trials with the result.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn close(
    case: Case,
    holdout: &Holdout,
    about: About,
    options: &Options,
    progress: impl FnMut(&Step),
) -> Result<Closed, CalibrationError> {
    let started = std::time::Instant::now();
    let prepared = prepared::prepare(case, options)?;
    let joined = joined_series(&prepared);
    let traced = trace::trace(&prepared, &joined, options, progress);
    let model = traced.after.model();
    let before = left_out(&traced.problem, &traced.bare);
    let after = left_out(&traced.problem, &traced.last);
    let Found { effects, minor, clock_correction } = found(&prepared, &traced, after.as_ref(), options);
    let mut left = left(&prepared, &traced, before.as_ref(), after.as_ref(), options.seed);
    left.not_tried.extend(own_not_tried(&prepared, options));
    let verdict = verdict(&traced, &effects, &left);
    let agrees = agrees(&traced.problem, &traced.last, options.criteria.negligible * sum(&traced.bare_losses));
    let effects = downgraded(effects, verdict, agrees);
    let (effects, clock_correction) = widened(effects, clock_correction, about.clock_interval);
    let is_open = !matches!(verdict, Verdict::Named | Verdict::NoEffect);
    let open = after.as_ref().filter(|_| is_open);
    let symbolic = open.and_then(|left| symbolic(&left.remainder(&traced.problem, traced.noise), &left.absorbed));
    let mut cautions = about.cautions;
    cautions.extend(prepared.caution.clone());
    cautions.extend(extrapolated(&prepared.case, holdout.trials()));
    if !traced.problem.blocks.by_trial {
        cautions.push("Few trials: regions of time were left out in turn instead of trials, which is weaker.".into());
    }
    if !effects.is_empty() && !agrees {
        cautions.push(
            "The saved model predicts the development trials otherwise than the search did: names and values are in doubt."
                .into(),
        );
    }
    let begun = traced.histories.iter().flatten().count();
    if begun > 0 && !effects.is_empty() {
        cautions.push(format!(
            "{begun} development trials are predicted from what their actuators did before the first sample, which their start tells. The saved \
             model begins at rest at the first sample."
        ));
    }
    // Everything is chosen: only now are held-out trials predicted.
    let measure = Measure {
        rig: &prepared.case.rig,
        weight: &prepared.weight,
        reported: prepared.case.reported.clone(),
        unit: prepared.unit(),
        noise: traced.noise,
        seed: options.seed,
        offsets: traced.offsets.is_some(),
    };
    let baselines = traced.baselines.each_ref();
    let judged = holdout.judge(baselines, &model, &modes(&traced.last), traced.common.as_ref(), &measure);
    let [zero_order_hold, quartic_interpolation] = between_samples(&model);
    let finding = Finding {
        format: 2,
        sentence: String::new(),
        verdict,
        next_experiment: next_experiment(verdict, &effects),
        equivalent: effects.first().map_or(vec![], |effect| effect.equivalent.clone()),
        figures: figures(&prepared, holdout, &traced, &effects, &judged, &measure),
        clock_correction,
        zero_order_hold,
        quartic_interpolation,
        before: ways(&traced),
        trial_offset: traced.offsets.map(|offsets| offsets.size),
        removed: judged.removed,
        confirmation: judged.confirmation,
        errors: judged.errors,
        steps: traced.steps.clone(),
        left,
        symbolic,
        cautions,
        networks: vec![],
        data: named(about.data, &prepared, holdout),
        seconds: started.elapsed().as_secs_f64(),
        configuration: about.configuration,
        version: about.version,
        effects,
        minor,
    };
    let finding = Finding { sentence: sentence::sentence(&finding), ..finding };
    Ok(Closed { finding, model })
}

/// Returns the calibration and development trials, with blocks of their own.
fn joined_series(prepared: &Prepared) -> Vec<Series> {
    let mut all: Vec<Series> = prepared.calibration.iter().chain(&prepared.development).cloned().collect();
    number_blocks(&mut all);
    all
}

/// Returns the actuator history of each trial that has one.
fn ways(traced: &Traced) -> Vec<BeforeTrial> {
    let known = traced.problem.series.iter().zip(&traced.histories);
    let told = known.filter_map(|(series, before)| Some((series.name.clone(), before.as_ref()?)));
    told.map(|(trial, before)| match before {
        Before::Rest(values) => BeforeTrial { trial, form: BeforeForm::Rest, values: values.clone() },
        Before::Turn(values) => BeforeTrial { trial, form: BeforeForm::Turn, values: values.clone() },
    })
    .collect()
}

fn verdict(traced: &Traced, effects: &[FoundEffect], left: &Left) -> Verdict {
    let [before, after, _] = traced.mean_squares();
    let evidence = Evidence {
        effects: traced.chosen.len(),
        at_bound: AtBound::of(effects),
        before,
        after,
        noise: traced.noise * traced.noise,
        probes: [left.probe.as_ref(), left.network.as_ref()],
        events: &left.events,
    };
    evidence.verdict()
}

/// Returns the names of the actuators with zero-order hold, and of those with quartic interpolation.
fn between_samples(model: &AugmentedModel) -> [Vec<String>; 2] {
    let inter_sample = model.inter_sample();
    let names = inter_sample.actuators().iter().map(|&a| model.rig().actuators[a].name.clone()).collect();
    if matches!(inter_sample, InterSample::Quartic(_)) { [vec![], names] } else { [names, vec![]] }
}

/// Returns the remaining error on development trials, and the results of the probes.
fn left(prepared: &Prepared, traced: &Traced, before: Option<&LeftOut>, after: Option<&LeftOut>, seed: u64) -> Left {
    let [.., last] = traced.mean_squares();
    let rms = (last - traced.noise.powi(2)).max(0.0).sqrt();
    let mut left = Left {
        rms,
        probe: None,
        network: None,
        events: vec![],
        autocorrelation: Autocorrelation::default(),
        not_tried: not_tried(prepared),
    };
    if let (Some(before), Some(after)) = (before, after) {
        let [before, after] = [before, after].map(|out| out.remainder(&traced.problem, traced.noise));
        left.probe = Some(probe(&after, seed));
        left.network = Some(recurrent(&after, seed));
        left.events = events(&after);
        left.autocorrelation = autocorrelation(&before, &after);
    }
    left
}

fn not_tried(prepared: &Prepared) -> Vec<NotTried> {
    let names = acm_core::effects::ALL.iter().map(|effect| effect.name());
    let tried = |name: &str| prepared.library.iter().any(|instance| instance.effect().name() == name);
    let lost = names.filter(|name| !tried(name));
    lost.map(|name| NotTried { name: name.into(), reason: sentence::why_not(name, prepared) }).collect()
}

/// Returns the user's own effects that were not tried, with the reasons.
fn own_not_tried(prepared: &Prepared, options: &Options) -> Vec<NotTried> {
    let tried = |name: &str| prepared.library.iter().any(|instance| instance.effect().name() == name);
    let lost = options.own.iter().filter(|own| !tried(own.name()));
    let reason = |can: bool| match can {
        true => "left out by the configuration, or the trials do not cover what it depends on",
        false => "nothing that it acts on, or may be carried by, varies",
    };
    let can = |own: &Own| !own.carriers(&prepared.case.rig).is_empty();
    lost.map(|own| NotTried { name: own.name().into(), reason: reason(can(own)).into() }).collect()
}

fn next_experiment(verdict: Verdict, effects: &[FoundEffect]) -> Option<String> {
    let open = effects.iter().find_map(|effect| to_separate(&effect.equivalent));
    open.or_else(|| {
        match verdict {
        Verdict::UnknownStructure | Verdict::Partial => {
            Some("move one actuator at a time, the others at rest, and look at what is left against each signal".into())
        }
        Verdict::UnmeasuredDisturbance => Some(
            "repeat one trial exactly: what does not repeat is carried by a signal that is not recorded (wind, tilt of \
             the carrier, temperature)"
                .into(),
        ),
        Verdict::Event => Some("repeat the trial in which it happened".into()),
        _ => None,
    }
    })
}

fn named(data: Data, prepared: &Prepared, holdout: &Holdout) -> Data {
    let names = |trials: &[Trial]| trials.iter().map(|trial| trial.name.clone()).collect();
    Data {
        calibration: names(&prepared.case.calibration),
        development: names(&prepared.case.development),
        held_out: holdout.names(),
        ..data
    }
}
