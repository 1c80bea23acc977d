//! One campaign or rig: generated, traced as a user's recordings would be, then compared with the truth.

use acm_datasets::Campaign;
use acm_datasets::generate::small_rig;
use acm_datasets::generate::undeclared::{UndeclaredCampaign, generate, generate_without_noise};
use acm_sim::small_rigs::{self, Role, deviations, oracle, simulate};
use acm_sim::twin::TwinError;
use acm_sim::twin::undeclared::{Design, Kind, Truth};
use acm_trace::close::{About, close};
use acm_trace::finding::{Data, Finding, FoundEffect};
use acm_trace::trace::Options;

use super::answer;
use super::figures::{RigRow, SeveralRow};
use super::plan::Task;
use super::single::{ParameterRow, Row, parameters, with_values_without_noise};
use crate::error::EvalError;
use crate::question::recordings::recordings;

/// Runs the loop on one campaign.
///
/// # Errors
/// An arm without equilibrium, or a nominal model that cannot be calibrated: both would be faults of the program.
pub fn attempt(task: &Task, options: &Options) -> Result<Row, EvalError> {
    let (_, truth, finding) = undeclared(task, options)?;
    let row = Row::new(task, &truth, &finding);
    if row.parameters.is_empty() {
        return Ok(row);
    }
    let without_noise = without_noise(task, &finding, options)?;
    Ok(Row { parameters: with_values_without_noise(row.parameters, &without_noise), ..row })
}

/// Searches among the effects of a finding in the same campaign without noise, and returns the true parameters that are found there;
/// none where the set is another one, since a value beside other effects is another value.
fn without_noise(task: &Task, finding: &Finding, options: &Options) -> Result<Vec<ParameterRow>, EvalError> {
    let set = |finding: &Finding| -> Vec<(String, Vec<String>)> {
        let names = |effect: &FoundEffect| effect.parameters.iter().map(|parameter| parameter.name.clone()).collect();
        finding.effects.iter().map(|effect| (effect.name.clone(), names(effect))).collect()
    };
    let only: Vec<String> = finding.effects.iter().map(|effect| effect.name.clone()).collect();
    if only.is_empty() {
        return Ok(vec![]);
    }
    let only = Some(only);
    let made = made(task, generate_without_noise)?;
    let quiet = traced(&made.campaign, &Options { only, ..options.clone() }, &name(task))?;
    let is_same = set(&quiet) == set(finding);
    Ok(if is_same { parameters(&made.truth.effects, &quiet.effects) } else { vec![] })
}

/// Number of millimetres in a metre.
const MM: f64 = 1e3;

/// Runs the loop on one campaign of several causes.
///
/// # Errors
/// As [`attempt`].
pub fn attempt_several(task: &Task, options: &Options) -> Result<SeveralRow, EvalError> {
    let (trials, truth, finding) = undeclared(task, options)?;
    let answer = answer::undeclared(&truth, &finding);
    Ok(SeveralRow {
        seed: task.seed,
        design: task.design,
        trials,
        before: MM * finding.errors.baselines.best().value,
        after: MM * finding.errors.after.value,
        noise: truth.irreducible_mm,
        verdict: finding.verdict,
        seconds: finding.seconds,
        answer,
    })
}

/// Number of redraws of the noise that an ideal width is taken from.
const REDRAWS: u64 = 60;

/// Runs the loop on one small rig. The oracle is computed before the search.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn attempt_small_rig((kind, seed): (small_rigs::Kind, u64), options: &Options) -> Result<RigRow, EvalError> {
    let rig = simulate(kind, seed);
    let known = oracle(&rig);
    let finding = traced(&small_rig::campaign(&rig), options, &rig.name)?;
    Ok(RigRow {
        seed,
        records: rig.trials(Role::Development).count(),
        error: finding.errors.after.value,
        before: finding.errors.baselines.best().value,
        oracle: known.error,
        noise: known.noise,
        seconds: finding.seconds,
        answer: answer::small_rig(kind, &rig, &known, &finding, || deviations(kind, seed, &known, REDRAWS)),
    })
}

/// Returns the number of trials, truth and finding of a campaign.
fn undeclared(task: &Task, options: &Options) -> Result<(usize, Truth, Finding), EvalError> {
    let made = made(task, generate)?;
    let own = task.without_own.then(|| made.truth.forms().into_iter().map(String::from)).into_iter().flatten();
    let options = Options { without: options.without.iter().cloned().chain(own).collect(), ..options.clone() };
    let finding = traced(&made.campaign, &options, &name(task))?;
    Ok((made.campaign.trials.len(), made.truth, finding))
}

/// Makes the campaign of a task.
fn made(
    task: &Task,
    generate: impl FnOnce(u64, Design, Option<Kind>) -> Result<UndeclaredCampaign, TwinError>,
) -> Result<UndeclaredCampaign, EvalError> {
    let made = generate(task.seed, task.design, Some(task.kind));
    made.map_err(|error| EvalError::Data(format!("{}: {error}", name(task))))
}

fn name(task: &Task) -> String {
    format!("seed {}, {}", task.seed, task.design.name())
}

fn traced(campaign: &Campaign, options: &Options, name: &str) -> Result<Finding, EvalError> {
    let given = recordings(campaign, campaign.nominal_spec(), false)?;
    let about = About {
        data: Data {
            name: campaign.manifest.name.clone(),
            title: campaign.manifest.title.clone(),
            hash: campaign.hash.clone(),
            synthetic: true,
            calibration: vec![],
            development: vec![],
            held_out: vec![],
        },
        configuration: serde_json::Value::Null,
        version: env!("CARGO_PKG_VERSION").into(),
        cautions: given.cautions,
        clock_interval: given.clock_interval,
    };
    let closed = close(given.case, &given.holdout, about, options, |_| {});
    Ok(closed.map_err(|error| EvalError::Data(format!("{name}: {error}")))?.finding)
}
