//! Closing the loop: from a case to a finding, with the model that has what was found.

use acm_core::augmented::AugmentedModel;
use acm_core::calibration::CalibrationError;
use acm_core::response::Response;
use nalgebra::{DMatrix, DVector};

use crate::autocorrelation::autocorrelation;
use crate::case::Case;
use crate::evaluate::{Point, Tip};
use crate::events::events;
use crate::experiment::to_separate;
use crate::finding::{Data, Figures, Finding, FoundEffect, Left, NotTried, Step, Verdict};
use crate::fit::{Scored, fit, score};
use crate::found::effects;
use crate::ground;
use crate::judge::{Judged, Model};
use crate::moving;
use crate::prepared::{self, Prepared};
use crate::probe::probe;
use crate::rules::compare;
use crate::sentence;
use crate::series::{Series, number_blocks};
use crate::setup::Setup;
use crate::symbolic::symbolic;
use crate::trace::{self, Options, Traced};
use crate::verdict::Evidence;

/// Share of the mean square left out that a calibration has to gain to move beyond what its own trials allow.
const FREE_SHARE: f64 = 0.1;

/// Share of the mean square of a free calibration alone that effects with a free calibration may leave.
const NEEDED: f64 = 0.5;

/// Times the noise from which on there is something to gain by it.
const FAR: f64 = 1.5;

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// What the caller knows and the finding repeats.
#[derive(Debug, Clone)]
pub struct About {
    /// Which data; names of trials are filled in.
    pub data: Data,
    /// As resolved.
    pub configuration: serde_json::Value,
    /// Of the program.
    pub version: String,
    /// What weakens the conclusion.
    pub cautions: Vec<String>,
}

/// A finding, and the model that has what was found.
#[derive(Debug, Clone)]
pub struct Closed {
    /// To be written to `loop.json`.
    pub finding: Finding,
    /// A model like any other.
    pub model: AugmentedModel,
}

/// Finds what the nominal model of a case lacks, adds it, and judges the result on untouched trials.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn close(
    case: Case,
    about: About,
    options: &Options,
    progress: impl FnMut(&Step),
) -> Result<Closed, CalibrationError> {
    let begun = std::time::Instant::now();
    let prepared = prepared::prepare(case, options)?;
    let joined = joined_series(&prepared);
    let traced = trace::trace(&prepared, &joined, options, progress);
    let scale = if prepared.is_length() { MM } else { 1.0 };
    let (last, response) = free_if_better(&prepared, &traced);
    let response = mapped_again(&prepared, &traced, &last, response);
    let after = Model {
        response,
        instances: last.fit.instances.clone(),
        theta: last.fit.theta.clone(),
        noise: traced.setup.noise,
    };
    let judged = Judged::new(&prepared, &traced, &after, &joined, options.seed, scale);
    let left = left(&prepared, &traced, &last, options.seed, scale);
    let noise = traced.floor * traced.floor * scale * scale;
    let evidence = Evidence {
        effects: last.fit.instances.len(),
        at_bound: last.fit.rests_on_bound(),
        first: traced.first * scale * scale,
        before: traced.bare.mean_square() * scale * scale,
        after: last.mean_square() * scale * scale,
        noise,
        probe: left.probe.as_ref(),
        events: &left.events,
    };
    let found = evidence.verdict();
    let effects = effects(&prepared, &traced, &last, scale);
    let equivalent = effects.first().map_or(vec![], |effect| effect.equivalent.clone());
    // What the untouched trials say decides nothing but the words.
    let symbolic = (!matches!(found, Verdict::Named | Verdict::NoEffect)).then(|| {
        let remainder = moving::remainder(&traced.setup, &last, &prepared.case.rig, traced.floor);
        let absorbed: Vec<DMatrix<f64>> = traced.setup.references.iter().map(|r| r.by_parameter.clone()).collect();
        symbolic(&remainder, &absorbed)
    });
    let mut symbolic = symbolic.flatten();
    symbolic.iter_mut().for_each(|symbolic| symbolic.error *= scale);
    let verdict = judged.temper(found);
    let mut cautions = about.cautions;
    if !prepared.by_trial {
        cautions.push("Few trials: parts of time were left out in turn instead of trials, which is weaker.".into());
    }
    let finding = Finding {
        format: 1,
        sentence: String::new(),
        verdict,
        next_experiment: next_experiment(verdict, &effects),
        removed: judged.removed,
        errors: judged.errors,
        equivalent,
        steps: scaled_steps(&traced.steps, scale),
        left,
        symbolic,
        cautions,
        networks: vec![],
        figures: in_order(judged.figures, &traced.order),
        data: named(about.data, &prepared),
        seconds: begun.elapsed().as_secs_f64(),
        configuration: about.configuration,
        version: about.version,
        effects,
    };
    let finding = Finding { sentence: sentence::sentence(&finding), ..finding };
    let terms = after.instances.into_iter().zip(after.theta).collect();
    let stands_for = prepared.nominal.stands_for.clone();
    let model = AugmentedModel::assembled(prepared.case.rig.clone(), after.response, stands_for, terms);
    Ok(Closed { finding, model })
}

/// Figures of the effects in the order in which these were found.
fn in_order(mut figures: Figures, order: &[usize]) -> Figures {
    if figures.carriers.len() == order.len() {
        let mut pairs: Vec<_> = order.iter().zip(figures.carriers).collect();
        pairs.sort_by_key(|(order, _)| **order);
        figures.carriers = pairs.into_iter().map(|(_, figure)| figure).collect();
    }
    figures
}

/// Calibration and development trials, with blocks of their own.
fn joined_series(prepared: &Prepared) -> Vec<Series> {
    let mut all: Vec<Series> = prepared.calibration.iter().chain(&prepared.development).cloned().collect();
    number_blocks(&mut all);
    all
}

/// The last model, or the same with its calibration free to move, whichever predicts blocks left out better.
fn free_if_better(prepared: &Prepared, traced: &Traced) -> (Scored, Response) {
    let setup = &traced.setup;
    let at = |scored: &Scored, setup: &Setup| {
        let moved =
            setup.response.parameters().iter().zip(scored.fit.delta.iter()).map(|(p, d)| p + d).collect::<Vec<f64>>();
        setup.response.with_parameters(&moved)
    };
    let last = &traced.last;
    if last.fit.instances.is_empty() {
        // Nothing was found, so nothing changes.
        let nominal = Response::new(prepared.nominal.model.clone(), None, None);
        return (last.clone(), nominal.with_map(traced.map.clone()));
    }
    let far = last.mean_square() > (FAR * traced.floor).powi(2);
    if far && setup.precision.amax() > 0.0 {
        let free = setup.calibrated();
        let loose = setup.with_precision(DMatrix::zeros(free, free));
        let again = fit(&loose, &last.fit.instances, &last.fit.theta, &last.fit.delta, Tip::Exact, 6);
        let again = score(&loose, again, Tip::Exact);
        let better = compare(&last.left_out, &again.left_out);
        let alone = score(&loose, fit(&loose, &[], &[], &last.fit.delta, Tip::Exact, 6), Tip::Exact);
        // Where the calibration explains as much without the effects, it would only hide that they do not.
        let needed = again.mean_square() < NEEDED * alone.mean_square();
        if needed && better.gain > FREE_SHARE * last.mean_square() && better.significance() > 2.0 {
            let response = at(&again, &loose);
            return (again, response);
        }
    }
    (last.clone(), at(last, setup))
}

/// With the effects in place, what is left at rest is learned once more, from calibration and development trials together; as
/// before where that predicts trials left out no better.
fn mapped_again(prepared: &Prepared, traced: &Traced, last: &Scored, response: Response) -> Response {
    if last.fit.instances.is_empty() || prepared.calibration.is_empty() || traced.joined {
        return response;
    }
    let learned = |response: &Response| {
        let setup =
            ground::bare(&prepared.case, &prepared.calibration, response.clone(), &prepared.weight, traced.setup.noise);
        let (instances, theta) = (&last.fit.instances, &last.fit.theta);
        let free = setup.calibrated();
        let (zero, none) = (DVector::zeros(free), (DMatrix::zeros(free, free), DVector::zeros(free)));
        let (rig, weight) = (&prepared.case.rig, prepared.weight.clone());
        let (series, noise) = (&prepared.development, traced.setup.noise);
        let flown = Setup::new(rig, series, response.clone(), instances, theta, weight, noise, none);
        let with = Point { instances, theta, delta: &zero };
        let without = Point { instances: &[], theta: &[], delta: &zero };
        ground::common_map(&[(&setup, without), (&flown, with)])
    };
    if learned(&response).is_none() {
        return response;
    }
    let plain = response.with_map(None);
    match learned(&plain) {
        Some(map) => plain.with_map(Some(map)),
        None => response,
    }
}

/// What remains on development trials.
fn left(prepared: &Prepared, traced: &Traced, last: &Scored, seed: u64, scale: f64) -> Left {
    let rig = &prepared.case.rig;
    let after = moving::remainder(&traced.setup, last, rig, traced.floor);
    let before = moving::remainder(&traced.bare_setup, &traced.bare, rig, traced.floor);
    let mut probe = probe(&after, seed);
    probe.rms *= scale;
    Left {
        rms: (last.mean_square() - traced.floor.powi(2)).max(0.0).sqrt() * scale,
        probe: Some(probe),
        events: events(&after),
        autocorrelation: autocorrelation(&before, &after),
        not_tried: not_tried(prepared),
    }
}

fn not_tried(prepared: &Prepared) -> Vec<NotTried> {
    let names = acm_core::effects::ALL.iter().map(|effect| effect.name());
    let tried = |name: &str| prepared.library.iter().any(|instance| instance.effect().name() == name);
    let lost = names.filter(|name| !tried(name));
    lost.map(|name| NotTried { name: name.into(), reason: sentence::why_not(name, prepared) }).collect()
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

fn scaled_steps(steps: &[Step], scale: f64) -> Vec<Step> {
    let mut steps = steps.to_vec();
    for step in &mut steps {
        step.error *= scale;
        step.candidates.iter_mut().for_each(|candidate| candidate.error *= scale);
    }
    steps
}

fn named(data: Data, prepared: &Prepared) -> Data {
    let names = |trials: &[crate::case::Trial]| trials.iter().map(|trial| trial.name.clone()).collect();
    Data {
        calibration: names(&prepared.case.calibration),
        development: names(&prepared.case.development),
        untouched: names(&prepared.case.untouched),
        ..data
    }
}
