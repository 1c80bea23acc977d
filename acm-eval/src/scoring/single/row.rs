//! One finding against the truth.

use acm_sim::twin::undeclared::{Class, Design, Since, TrueEffect, Truth};
use acm_trace::finding::{Finding, Verdict};
use serde::{Deserialize, Serialize};

use super::parameters::{ParameterRow, parameters};
use crate::scoring::aliases::ALIAS;
use crate::scoring::answer::{self, Answer, Names, TrueCause, matching::matching};
use crate::scoring::plan::Task;

/// Correctness of the first effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Top {
    /// The name is the true one.
    Name,
    /// The data cannot distinguish the name from the true one.
    Alias,
    /// The name is another one.
    Wrong,
    /// Nothing was found.
    None,
}

/// One campaign: its truth, and the finding.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Row {
    /// Seed of the campaign.
    pub seed: u64,
    /// Motion of actuators and vehicle.
    pub design: Design,
    /// Mechanism.
    pub kind: String,
    /// Correct class of answer.
    pub class: Class,
    /// Onset of the mechanism; of the first of two.
    pub since: Option<Since>,
    /// True names in the library.
    pub truth: Vec<String>,
    /// Claims and truth.
    pub answer: Answer,
    /// RMS of the mechanisms in held-out trials, without noise, mm.
    pub size: f64,
    /// Whether the library lacked the true effect.
    pub without_own: bool,
    /// Verdict.
    pub verdict: Verdict,
    /// Names found, in their order.
    pub found: Vec<String>,
    /// Names that explain as much as the first.
    pub equivalent: Vec<String>,
    /// Correctness of the first name.
    pub top: Top,
    /// Largest mutual share of the first name and a true one: 1 for the true one.
    pub top_share: f64,
    /// Number of true effects whose name is in the set: found names and their equivalents.
    pub in_set_by_name: usize,
    /// Number found, counting names that the data cannot distinguish from the true one.
    pub in_set: usize,
    /// Number of true effects that are found, by name or by an indistinguishable effect; each name counts once.
    pub right: usize,
    /// Errors of the nominal model, with static map, and recalibrated, on held-out trials, mm.
    pub before: [f64; 3],
    /// Error with the effects that were found, mm.
    pub after: f64,
    /// White noise as estimated, mm.
    pub floor: f64,
    /// Noise that no recording explains, mm.
    pub true_floor: f64,
    /// Removed share F, with the noise as estimated.
    pub removed: Option<f64>,
    /// Removed share F, with the true noise.
    pub removed_over_true_floor: Option<f64>,
    /// Parameters that have a counterpart.
    pub parameters: Vec<ParameterRow>,
    /// True parameters of effects that were found by name.
    pub parameters_true: usize,
    /// Probability p of the probe and its prediction of the remaining residual, mm; none where it did not run.
    pub probe: Option<[f64; 2]>,
    /// Parameters that rest on a bound.
    pub at_bound: Vec<String>,
    /// Steps of the search, each with its cross-validated error, mm.
    pub steps: Vec<(String, f64)>,
    /// Formula of the remaining residual.
    pub symbolic: Option<String>,
    /// Computing time, s.
    pub seconds: f64,
}

impl Row {
    /// Compares a finding with the truth.
    pub fn new(task: &Task, truth: &Truth, finding: &Finding) -> Self {
        let found: Vec<String> = finding.effects.iter().map(|effect| effect.name.clone()).collect();
        let mut set: Vec<&str> = found.iter().map(String::as_str).collect();
        set.extend(finding.effects.iter().flat_map(|effect| &effect.equivalent).map(String::as_str));
        let errors = &finding.errors;
        let baselines = [errors.baselines.nominal, errors.baselines.static_map, errors.baselines.recalibrated];
        let before = baselines.map(|estimate| MM * estimate.value);
        let after = MM * errors.after.value;
        let true_floor = truth.irreducible_mm;
        let answer = answer::undeclared(truth, finding);
        let top_share = found.first().map_or(0.0, |name| share(&answer.causes, name));
        let named = |effect: &&TrueEffect| found.iter().any(|name| Some(name) == effect.name.as_ref());
        Self {
            seed: truth.seed,
            design: truth.design,
            kind: truth.kind.clone(),
            class: truth.class,
            since: truth.effects.first().map(|effect| effect.since),
            truth: truth.names().into_iter().map(String::from).collect(),
            size: truth.held_out_rms_mm,
            without_own: task.without_own,
            verdict: finding.verdict,
            top: top(&answer.causes, found.first().map(String::as_str)),
            top_share,
            in_set_by_name: truth.names().iter().filter(|name| set.contains(name)).count(),
            in_set: answer.causes.iter().filter(|cause| set.iter().any(|name| cause.share(name) >= ALIAS)).count(),
            right: right(&answer.causes, &found),
            equivalent: finding.equivalent.clone(),
            before,
            after,
            floor: MM * errors.noise,
            true_floor,
            removed: finding.removed,
            removed_over_true_floor: answer.removed,
            parameters: parameters(&truth.effects, &finding.effects),
            parameters_true: truth.effects.iter().filter(named).map(|effect| effect.parameters.len()).sum(),
            probe: finding.left.probe.as_ref().map(|probe| [probe.p, MM * probe.rms]),
            at_bound: at_bound(finding),
            steps: finding.steps.iter().map(|step| (step.model.clone(), MM * step.error)).collect(),
            symbolic: finding.symbolic.as_ref().map(|symbolic| symbolic.formula.clone()),
            seconds: finding.seconds,
            found,
            answer,
        }
    }

    /// Returns whether any name is sure.
    pub fn names(&self) -> bool {
        self.answer.claims.iter().any(|claim| claim.sure)
    }

    /// Returns whether a sure name stands for no cause.
    pub fn names_wrong(&self) -> bool {
        !Names::new(&self.answer).wrong.is_empty()
    }

    /// Returns whether the library has the acting effect.
    pub fn is_known(&self) -> bool {
        matches!(self.class, Class::Inside | Class::Pair | Class::Several)
    }
}

fn at_bound(finding: &Finding) -> Vec<String> {
    let parameters = finding.effects.iter().flat_map(|effect| effect.parameters.iter().map(move |p| (effect, p)));
    parameters.filter(|(_, p)| p.at_bound).map(|(effect, p)| format!("{} {}", effect.name, p.name)).collect()
}

/// Returns the largest mutual share of a name and a true one.
fn share(causes: &[TrueCause], name: &str) -> f64 {
    causes.iter().map(|cause| cause.share(name)).fold(0.0, f64::max)
}

fn top(causes: &[TrueCause], first: Option<&str>) -> Top {
    match first {
        None => Top::None,
        Some(name) if causes.iter().any(|cause| cause.name.as_deref() == Some(name)) => Top::Name,
        Some(name) if share(causes, name) >= ALIAS => Top::Alias,
        Some(_) => Top::Wrong,
    }
}

/// Returns the number of true effects that one of the names stands for, each name for one of them.
fn right(causes: &[TrueCause], found: &[String]) -> usize {
    let stands = |name: usize, cause: usize| causes[cause].share(&found[name]) >= ALIAS;
    matching(found.len(), causes.len(), stands).into_iter().flatten().count()
}

/// Factor from SI to shown values: campaigns of the score have positions alone.
const MM: f64 = 1e3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::answer::cause;

    fn effect(name: &str, also: &[&str]) -> TrueCause {
        cause(name, None, also, true)
    }

    fn found(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_string()).collect()
    }

    #[test]
    fn one_name_does_not_stand_for_two_effects() {
        let truth = [effect("backlash", &["dead_time"]), effect("dead_time", &["backlash"])];
        assert_eq!(right(&truth, &found(&["dead_time"])), 1);
        assert_eq!(right(&truth, &found(&["dead_time", "backlash"])), 2);
        assert_eq!(right(&truth, &found(&["creep"])), 0);
        assert_eq!(right(&truth[..1], &found(&["creep", "dead_time"])), 1);
    }
}
