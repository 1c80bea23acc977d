//! One finding against the truth.

use acm_sim::twin::undeclared::{Class, Design, Since, TrueEffect, Truth};
use acm_trace::finding::{Finding, Verdict};
use serde::Serialize;

use super::{
    matching::matching,
    parameters::{ParameterRow, parameters},
    plan::Task,
};

/// How right the effect is that was found first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Top {
    /// It has the true name.
    Name,
    /// The data cannot tell it from the true one.
    Alias,
    /// Something else.
    Wrong,
    /// Nothing was found.
    None,
}

/// One campaign: what was true, what was found.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Of the campaign.
    pub seed: u64,
    /// How actuators and vehicle moved.
    pub design: Design,
    /// What was the matter.
    pub kind: String,
    /// What a finder should say.
    pub class: Class,
    /// Since when it acts; the first of two.
    pub since: Option<Since>,
    /// True names in the library.
    pub truth: Vec<String>,
    /// Names that the data cannot tell from them.
    pub also: Vec<String>,
    /// RMS of the mechanisms in held-out trials, without noise, mm.
    pub size: f64,
    /// Whether the library lacked the true effect.
    pub without_own: bool,
    /// What was concluded.
    pub verdict: Verdict,
    /// Names found, in their order.
    pub found: Vec<String>,
    /// Names that explain as much as the first.
    pub equivalent: Vec<String>,
    /// How right the first name is.
    pub top: Top,
    /// True effects whose name stands in the set: names found and what is equivalent to them.
    pub in_set_by_name: usize,
    /// The same, with names that the data cannot tell from the true one.
    pub in_set: usize,
    /// True effects that are found, by name or by one that is as right; each name counts once.
    pub right: usize,
    /// Nominal, with static map, recalibrated, on held-out trials, mm.
    pub before: [f64; 3],
    /// With what was found, mm.
    pub after: f64,
    /// White noise as estimated, mm.
    pub floor: f64,
    /// White noise as it is, mm.
    pub true_floor: f64,
    /// F, with the noise as estimated.
    pub removed: Option<f64>,
    /// F, with the noise as it is.
    pub removed_over_true_floor: Option<f64>,
    /// Parameters that have a counterpart.
    pub parameters: Vec<ParameterRow>,
    /// True parameters of effects that were found by name.
    pub parameters_true: usize,
    /// p of the probe and what it predicts of the rest, mm; none where it did not run.
    pub probe: Option<[f64; 2]>,
    /// Parameters that rest on a bound.
    pub at_bound: Vec<String>,
    /// Steps of the search, each with its cross-validated error, mm.
    pub steps: Vec<(String, f64)>,
    /// Formula of what is left.
    pub symbolic: Option<String>,
    /// s.
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
        let true_floor = truth.white_noise_mm.hypot(truth.coloured_noise_mm);
        let named = |effect: &&TrueEffect| found.iter().any(|name| Some(name) == effect.name.as_ref());
        Self {
            seed: truth.seed,
            design: truth.design,
            kind: truth.kind.clone(),
            class: truth.class,
            since: truth.effects.first().map(|effect| effect.since),
            truth: truth.names().into_iter().map(String::from).collect(),
            also: truth.effects.iter().flat_map(|effect| &effect.also).map(|alias| alias.name.clone()).collect(),
            size: truth.held_out_rms_mm,
            without_own: task.without_own,
            verdict: finding.verdict,
            top: top(truth, found.first().map(String::as_str)),
            in_set_by_name: truth.names().iter().filter(|name| set.contains(name)).count(),
            in_set: truth.effects.iter().filter(|effect| set.iter().any(|name| stands_for(name, effect))).count(),
            right: right(&truth.effects, &found),
            equivalent: finding.equivalent.clone(),
            before,
            after,
            floor: MM * errors.noise,
            true_floor,
            removed: finding.removed,
            removed_over_true_floor: removed(before, after, true_floor),
            parameters: parameters(&truth.effects, &finding.effects),
            parameters_true: truth.effects.iter().filter(named).map(|effect| effect.parameters.len()).sum(),
            probe: finding.left.probe.as_ref().map(|probe| [probe.p, MM * probe.rms]),
            at_bound: at_bound(finding),
            steps: finding.steps.iter().map(|step| (step.model.clone(), MM * step.error)).collect(),
            symbolic: finding.symbolic.as_ref().map(|symbolic| symbolic.formula.clone()),
            seconds: finding.seconds,
            found,
        }
    }

    /// Whether something is named for sure.
    pub fn names(&self) -> bool {
        !self.found.is_empty() && matches!(self.verdict, Verdict::Named | Verdict::FormImperfect)
    }

    /// Whether the first effect, or one that explains as much, is what the data cannot tell from the true one.
    pub fn names_alias(&self) -> bool {
        self.equivalent.iter().any(|name| self.also.contains(name))
    }

    /// Whether the library has what acts.
    pub fn is_known(&self) -> bool {
        matches!(self.class, Class::Inside | Class::Pair | Class::Several)
    }
}

fn at_bound(finding: &Finding) -> Vec<String> {
    let parameters = finding.effects.iter().flat_map(|effect| effect.parameters.iter().map(move |p| (effect, p)));
    parameters.filter(|(_, p)| p.at_bound).map(|(effect, p)| format!("{} {}", effect.name, p.name)).collect()
}

fn stands_for(name: &str, effect: &TrueEffect) -> bool {
    effect.name.as_deref() == Some(name) || effect.also.iter().any(|alias| alias.name == name)
}

fn top(truth: &Truth, first: Option<&str>) -> Top {
    match first {
        None => Top::None,
        Some(name) if truth.names().contains(&name) => Top::Name,
        Some(name) if truth.accepts(name) => Top::Alias,
        Some(_) => Top::Wrong,
    }
}

/// True effects that one of the names stands for, each name for one of them.
fn right(truth: &[TrueEffect], found: &[String]) -> usize {
    let stands = |name: usize, effect: usize| stands_for(&found[name], &truth[effect]);
    matching(found.len(), truth.len(), stands).into_iter().flatten().count()
}

/// Shown per SI value: campaigns of the score have positions alone.
const MM: f64 = 1e3;

/// Below this share of the noise's mean square there is nothing to remove.
const NOTHING: f64 = 0.09;

fn removed(before: [f64; 3], after: f64, floor: f64) -> Option<f64> {
    let best = before.into_iter().fold(f64::INFINITY, f64::min);
    let removable = best * best - floor * floor;
    (removable > NOTHING * floor * floor).then(|| (best * best - after * after) / removable)
}

#[cfg(test)]
mod tests {
    use super::*;
    use acm_sim::twin::undeclared::Alias;

    fn effect(name: &str, also: &[&str]) -> TrueEffect {
        let alias = |name: &&str| Alias { name: (*name).into(), reason: String::new() };
        TrueEffect {
            kind: name.into(),
            name: Some(name.into()),
            inside: true,
            since: Since::Start,
            trial: None,
            also: also.iter().map(alias).collect(),
            parameters: vec![],
            formula: String::new(),
            held_out_rms_mm: 10.0,
            separable: true,
        }
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

    /// Oracle: hand arithmetic, with F = (b² − a²)/(b² − floor²).
    #[test]
    fn share_of_the_removable_error() {
        let share = removed([9.0, 7.0, 5.0], 3.5, 3.0).unwrap_or(f64::NAN);
        assert!((share - (25.0 - 12.25) / 16.0).abs() < 1e-12);
        assert_eq!(removed([3.1, 3.1, 3.1], 3.0, 3.0), None);
    }
}
