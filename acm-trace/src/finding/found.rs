//! Effects as they are reported: with values, intervals, confidence, and equivalent effects.

use acm_core::effects::ParameterSpec;
use acm_core::effects::instance::Instance;
use nalgebra::DMatrix;

use crate::diagnose::followed::followed;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::residuals::{LeftOut, changes, size};
use crate::finding::sentence;
use crate::finding::{Alternative, Confidence, Doubt, FoundEffect, FoundParameter, Level, MinorEffect, Probe, Verdict};
use crate::fit::interval::{Intervals, intervals};
use crate::prepared::Prepared;
use crate::search::candidates::CLOCK;
use crate::search::confidence::Chosen;
use crate::search::criteria::Criteria;
use crate::trace::{Options, Traced};

/// Effects and clock correction of the last model.
pub struct Found {
    /// Effects that are named, the largest first.
    pub effects: Vec<FoundEffect>,
    /// Minor effects, the largest first.
    pub minor: Vec<MinorEffect>,
    /// Correction of the clock.
    pub clock_correction: Option<FoundParameter>,
}

/// Returns the effects of the last model, and the correction of the clock; `left` has the residuals on blocks left out.
pub fn found(prepared: &Prepared, traced: &Traced, left: Option<&LeftOut>, options: &Options) -> Found {
    let bounds = bounds(traced);
    let remainder = left.map(|left| left.remainder(&traced.problem, traced.noise));
    let (mut effects, mut minor) = (vec![], vec![]);
    let named = traced.named();
    let most = may_follow(named.iter().flatten().count(), &options.criteria);
    for (i, chosen) in named.into_iter().enumerate() {
        let changes = changes(&traced.problem, &traced.last, i);
        let size = changes.as_ref().map_or(f64::NAN, |changes| size(&traced.problem, changes));
        match chosen {
            Some(chosen) => {
                let one = effect(prepared, traced, &options.criteria, bounds.as_ref(), (i, chosen, size));
                effects.push(of_its_form(one, most, remainder.as_ref(), changes.as_deref(), options.seed));
            }
            None => minor.push(minor_effect(traced, bounds.as_ref(), (i, size))),
        }
    }
    effects.sort_by(|a, b| b.size.total_cmp(&a.size));
    minor.sort_by(|a, b| b.size.total_cmp(&a.size));
    Found { effects, minor, clock_correction: clock(traced, bounds.as_ref()) }
}

fn minor_effect(traced: &Traced, bounds: Option<&Intervals>, (i, size): (usize, f64)) -> MinorEffect {
    let (rig, instance) = (traced.problem.rig, &traced.last.effects[i].instance);
    MinorEffect {
        name: instance.effect().name().into(),
        meaning: instance.effect().meaning().into(),
        carrier: sentence::carrier(instance, rig),
        parameters: parameters(traced, bounds, i, rig),
        size,
    }
}

/// Significance level of the test of an effect's form.
const BY_CHANCE: f64 = 0.05;

/// Returns the share of what an effect removes that may still follow it: errors of the other effects add to it.
fn may_follow(effects: usize, criteria: &Criteria) -> f64 {
    criteria.followed * (effects + 1) as f64
}

/// Downgrades a sure effect to likely where it predicts too much of the residual.
fn of_its_form(
    effect: FoundEffect,
    most: f64,
    remainder: Option<&Remainder>,
    changes: Option<&[DMatrix<f64>]>,
    seed: u64,
) -> FoundEffect {
    let (Some(remainder), Some(changes), Level::Sure) = (remainder, changes, effect.confidence.level) else {
        return effect;
    };
    let probe = followed(remainder, changes, seed);
    if !is_followed(&probe, most * effect.removes) {
        return effect;
    }
    FoundEffect { follows: Some(probe.rms), ..doubted(effect, Doubt::Followed) }
}

/// Returns whether the explained part is significant, and larger than `most`.
fn is_followed(probe: &Probe, most: f64) -> bool {
    probe.p <= BY_CHANCE && probe.rms > most
}

/// Returns the effects with downgraded confidence: none is sure where the verdict is unknown structure, or the saved model predicts
/// otherwise than the search did.
pub fn downgraded(effects: Vec<FoundEffect>, verdict: Verdict, agrees: bool) -> Vec<FoundEffect> {
    let unknown = (verdict == Verdict::UnknownStructure).then_some(Doubt::UnknownStructure);
    let doubts = || unknown.into_iter().chain((!agrees).then_some(Doubt::ModelDisagrees));
    effects.into_iter().map(|effect| doubts().fold(effect, doubted)).collect()
}

/// Returns an effect with one more doubt: it is likely at most.
fn doubted(mut effect: FoundEffect, doubt: Doubt) -> FoundEffect {
    effect.doubts.push(doubt);
    effect.confidence.level = effect.confidence.level.min(Level::Likely);
    effect
}

/// Returns the intervals of the last set, widened to those of the sets that predict as well or a little better.
fn bounds(traced: &Traced) -> Option<Intervals> {
    let (problem, last) = (&traced.problem, &traced.last);
    let mut bounds = intervals(problem, last)?;
    for rival in traced.chosen.iter().flat_map(|(_, chosen)| &chosen.rivals).chain(&traced.larger) {
        if let Some(theirs) = intervals(problem, rival) {
            bounds.span((last, problem.rig), rival, &theirs);
        }
    }
    Some(bounds)
}

fn effect(
    prepared: &Prepared,
    traced: &Traced,
    criteria: &Criteria,
    bounds: Option<&Intervals>,
    (i, chosen, size): (usize, &Chosen, f64),
) -> FoundEffect {
    let rig = &prepared.case.rig;
    let instance = &traced.last.effects[i].instance;
    let name = instance.effect().name();
    let share = chosen.share(name);
    let mut equivalent = vec![name.to_string()];
    for other in chosen.names() {
        if !equivalent.contains(&other) && other != CLOCK {
            equivalent.push(other);
        }
    }
    let parameters = parameters(traced, bounds, i, rig);
    let reasons = [
        (Doubt::Equivalent, equivalent.len() > 1),
        (Doubt::AtBound, parameters.iter().any(|parameter| parameter.at_bound)),
        (Doubt::MayBeZero, may_be_silent(instance, &parameters)),
        (Doubt::TakenBack, is_taken_back((size, traced.last.effects.len()), traced.mean_squares()[0].sqrt(), criteria)),
    ];
    let doubts: Vec<Doubt> = reasons.into_iter().filter(|(_, holds)| *holds).map(|(doubt, _)| doubt).collect();
    FoundEffect {
        name: name.into(),
        meaning: instance.effect().meaning().into(),
        site: instance.site(),
        carrier: sentence::carrier(instance, rig),
        parameters,
        size,
        removes: (chosen.rise.max(0.0) / traced.problem.rows().max(1) as f64).sqrt(),
        confidence: Confidence { level: level(share, !doubts.is_empty(), criteria), share },
        doubts,
        follows: None,
        equivalent,
        alternatives: chosen
            .shares
            .iter()
            .map(|(name, share)| Alternative { name: name.clone(), share: *share })
            .collect(),
        in_calibration: traced.problem.has_calibration().then_some(traced.last.effects[i].in_calibration),
        source: instance.effect().source().into(),
    }
}

/// Returns whether an effect has sizes, and the data allow each of them to be zero: it may not act at all.
fn may_be_silent(instance: &Instance, parameters: &[FoundParameter]) -> bool {
    let specs = instance.parameters();
    let is_size = |parameter: &&FoundParameter| {
        parameter.depends_on.is_some() || specs.iter().any(|spec| spec.name == parameter.name && spec.may_vary)
    };
    let mut sizes = parameters.iter().filter(is_size).peekable();
    sizes.peek().is_some() && !sizes.any(FoundParameter::differs_from_zero)
}

/// Returns whether other effects cancel most of what an effect does.
fn is_taken_back((size, effects): (f64, usize), error: f64, criteria: &Criteria) -> bool {
    effects > 1 && size > criteria.taken_back * error
}

/// Returns the confidence in words.
fn level(share: f64, in_doubt: bool, criteria: &Criteria) -> Level {
    match share {
        share if share >= criteria.sure && !in_doubt => Level::Sure,
        share if share >= criteria.likely => Level::Likely,
        _ => Level::Possible,
    }
}

fn parameters(traced: &Traced, bounds: Option<&Intervals>, i: usize, rig: &acm_core::rig::Rig) -> Vec<FoundParameter> {
    let (instance, theta) = &traced.after.effects[i];
    let free = |j: &usize| instance.parameters()[*j].is_free();
    (0..theta.len())
        .filter(free)
        .map(|j| {
            let spec = &instance.parameters()[j];
            let open = [f64::NEG_INFINITY, f64::INFINITY];
            // A parameter that rests at its neutral value is part of the model, and was not fitted.
            let interval = bounds
                .and_then(|all| all.effects[i][j])
                .map_or(if theta[j] == spec.neutral { [theta[j]; 2] } else { open }, |interval| {
                    interval.map(|bound| spec.inside(bound))
                });
            let depends_on = (j >= instance.own_parameters()).then(|| instance.context()).flatten();
            FoundParameter {
                name: spec.name.clone(),
                value: theta[j],
                unit: spec.unit.clone(),
                interval,
                undetermined: is_undetermined(spec, theta[j], interval),
                depends_on: depends_on.and_then(|c| c.signal(rig)).map(|signal| signal.name.clone()),
                at_bound: spec.is_at_bound(theta[j]),
            }
        })
        .collect()
}

fn clock(traced: &Traced, bounds: Option<&Intervals>) -> Option<FoundParameter> {
    (traced.last.clock != 0.0).then(|| FoundParameter {
        name: CLOCK.into(),
        value: traced.last.clock,
        unit: "s".into(),
        interval: bounds.and_then(|all| all.clock).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
        depends_on: None,
        at_bound: false,
        undetermined: false,
    })
}

/// Ratio of half an interval to a typical value beyond which the value is undetermined: two orders of magnitude.
const OPEN: f64 = 100.0;

/// Returns whether the interval has no end, holds all values that the effect admits, or is far wider than a typical
/// value.
fn is_undetermined(spec: &ParameterSpec, value: f64, [low, high]: [f64; 2]) -> bool {
    let reach = 0.5 * (high - low);
    let holds_all = spec.is_free() && low <= spec.lower && high >= spec.upper;
    holds_all || !(reach <= OPEN * spec.scale.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;

    use super::*;
    use crate::fit::bench;

    #[test]
    fn an_interval_without_end_or_far_beyond_what_is_typical_leaves_the_value_open() {
        let free = |typical| ParameterSpec::size("a", "1", typical);
        assert!(is_undetermined(&free(1.0), 0.0, [-6.3e157, 6.3e157]));
        assert!(is_undetermined(&free(1.0), 2.0, [f64::NEG_INFINITY, f64::INFINITY]));
        assert!(is_undetermined(&free(1.0), 2.0, [f64::NAN, f64::NAN]));
        assert!(!is_undetermined(&free(1e-3), 1e-9, [-1e-4, 1e-4]));
        assert!(!is_undetermined(&free(1.0), 5e3, [4e3, 6e3]));
        assert!(is_undetermined(&free(1.0).within(0.0, 4.0), 2.0, [0.0, 4.0]));
        assert!(!is_undetermined(&free(1.0).within(0.0, 4.0), 2.0, [0.0, 3.9]));
    }

    /// Oracle: the rule as the book has it.
    #[test]
    fn what_others_take_back_is_not_sure() {
        let of = |size, effects| is_taken_back((size, effects), 10.0, &Criteria::default());
        assert_eq!([of(31.0, 2), of(32.0, 2), of(32.0, 1)], [false, true, false]);
    }

    /// Oracle: by hand. A gain of −0.4 to 0.5 may be none; one of 0.1 to 0.5 is not, nor is an effect of which one of two sizes differs
    /// from zero; a time is no size.
    #[test]
    fn an_effect_that_may_be_silent_is_not_sure() {
        let rig = bench::rig(&["q1", "q2"], &[], &["y"]);
        let silent = |name: &str, intervals: &[(&str, [f64; 2])]| {
            let instance = bench::placed(name, Carrier::Rig, &rig, &[]).instance;
            let of = |&(name, interval): &(&str, [f64; 2])| FoundParameter {
                name: name.into(),
                value: 0.5 * (interval[0] + interval[1]),
                unit: "1".into(),
                interval,
                depends_on: None,
                at_bound: false,
                undetermined: false,
            };
            may_be_silent(&instance, &intervals.iter().map(of).collect::<Vec<_>>())
        };
        let gains =
            |first: [f64; 2], second: [f64; 2]| silent("static_gain", &[("gain_q1", first), ("gain_q2", second)]);
        assert!(gains([-0.4, 0.5], [-1.0, 0.0]));
        assert!(!gains([-0.4, 0.5], [0.1, 0.5]));
        assert!(!silent("second_order_lag", &[("damping", [0.0, 1.0])]));
    }

    /// Oracle: by hand. Of 10 mm that one effect removes 0.6 mm may follow it, of one of four 1.5 mm, and any that chance explains.
    #[test]
    fn an_effect_is_followed_beyond_chance_and_its_part() {
        let of = |effects: usize, p, rms| {
            let most = 0.010 * may_follow(effects, &Criteria::default());
            is_followed(&Probe { explained: 0.5, by_chance: 0.05, p, rms }, most)
        };
        assert_eq!([of(1, 0.01, 0.0005), of(1, 0.01, 0.0007), of(1, 0.06, 0.0007)], [false, true, false]);
        assert_eq!([of(4, 0.01, 0.0014), of(4, 0.01, 0.0016)], [false, true]);
    }

    /// Oracle: the rule as the book has it.
    #[test]
    fn an_unknown_structure_or_another_model_has_no_sure_name() {
        let found = |level| FoundEffect {
            name: "creep".into(),
            meaning: String::new(),
            site: acm_core::effects::Site::Actuation,
            carrier: None,
            parameters: vec![],
            size: 1.0,
            removes: 1.0,
            confidence: Confidence { level, share: 1.0 },
            doubts: vec![],
            follows: None,
            equivalent: vec![],
            alternatives: vec![],
            in_calibration: None,
            source: String::new(),
        };
        let of = |verdict, agrees| {
            let effects = [Level::Sure, Level::Likely, Level::Possible].map(found).to_vec();
            downgraded(effects, verdict, agrees).iter().map(|effect| effect.confidence.level).collect::<Vec<_>>()
        };
        let both = downgraded(vec![found(Level::Sure)], Verdict::UnknownStructure, false);
        assert_eq!(both[0].doubts, [Doubt::UnknownStructure, Doubt::ModelDisagrees]);
        assert_eq!(of(Verdict::Partial, true), [Level::Sure, Level::Likely, Level::Possible]);
        assert_eq!(of(Verdict::UnknownStructure, true), [Level::Likely, Level::Likely, Level::Possible]);
        assert_eq!(of(Verdict::Named, false), [Level::Likely, Level::Likely, Level::Possible]);
        assert_eq!(of(Verdict::Named, true), [Level::Sure, Level::Likely, Level::Possible]);
        assert_eq!(of(Verdict::FormImperfect, true), [Level::Sure, Level::Likely, Level::Possible]);
    }
}
