//! The finding in words: missing effects, confidence, and held-out errors.
//!
//! | part | from |
//! | --- | --- |
//! | claim | verdict, effects with their confidence, clock correction |
//! | evidence | errors on held-out trials, confirmation |
//!
//! For a refuted model the evidence comes first.

use acm_core::display::{Quantity, percent};
use acm_core::effects::instance::Instance;
use acm_core::effects::{Effect, Site, find};
use acm_core::rig::Rig;

use crate::finding::title::{effect_title, parameter_title};
use crate::finding::{Confirmation, Finding, FoundEffect, FoundParameter, Left, MinorEffect, Verdict};
use crate::prepared::Prepared;

/// Writes one sentence for a reader who sees nothing else; further ones for a clock and for an offset of each trial.
pub fn sentence(finding: &Finding) -> String {
    let (claim, numbers) = (claim(finding), numbers(finding));
    let first = match finding.confirmation {
        Confirmation::Refuted => {
            format!("Refuted by held-out trials: {numbers}. On development trials: {}.", uncapitalized(&claim))
        }
        confirmation => format!("{claim}; {}{numbers}.", evidence(finding, confirmation)),
    };
    let clock = clock(finding).filter(|_| !finding.effects.is_empty());
    let clock = clock.map(|clock| format!(" {}.", capitalized(&clock)));
    let offset = finding.trial_offset.map(|size| shown(finding, size));
    let offset = offset.map(|size| format!(" Each trial has an offset of its own ({size})."));
    [Some(first), clock, offset, minor(finding)].into_iter().flatten().collect()
}

/// Lists the minor effects.
fn minor(finding: &Finding) -> Option<String> {
    let named = |effect: &MinorEffect| effect_title(&effect.name) + &carried(effect.carrier.as_deref());
    let names: Vec<String> = finding.minor.iter().map(named).collect();
    (!names.is_empty())
        .then(|| format!(" The model also has minor effects, too small to be named: {}.", names.join(", ")))
}

fn carried(carrier: Option<&str>) -> String {
    carrier.map_or(String::new(), |name| format!(" of {name}"))
}

/// Returns the words before the errors on held-out trials.
fn evidence(finding: &Finding, confirmation: Confirmation) -> &'static str {
    match confirmation {
        Confirmation::Confirmed => "confirmed on held-out trials: ",
        Confirmation::Open => "neither confirmed nor refuted on held-out trials: ",
        Confirmation::NotTested if finding.adds() => "not tested on held-out trials: ",
        Confirmation::NotTested if finding.data.held_out.is_empty() => "held-out trials: ",
        Confirmation::NotTested | Confirmation::Refuted => "",
    }
}

fn numbers(finding: &Finding) -> String {
    let errors = &finding.errors;
    if finding.data.held_out.is_empty() {
        return "there is none".into();
    }
    format!(
        "error on held-out trials {} → {} (best baseline {}, noise {})",
        shown(finding, errors.baselines.nominal.value),
        shown(finding, errors.after.value),
        shown(finding, errors.baselines.best().value),
        shown(finding, errors.noise),
    )
}

fn shown(finding: &Finding, value: f64) -> String {
    finding.errors.display().show(value)
}

/// Words the claim. A clock stands first where nothing else was added.
fn claim(finding: &Finding) -> String {
    match clock(finding) {
        Some(clock) if finding.effects.is_empty() => format!("{}. {}", capitalized(&clock), beside_clock(finding)),
        _ => of_effects(finding),
    }
}

/// Writes a phrase such as `the actuators' clock is 0.85 s late; shift their stamps`.
pub fn clock(finding: &Finding) -> Option<String> {
    let FoundParameter { value, interval: [low, high], unit, .. } = finding.clock_correction.as_ref()?;
    let bounds = if *value < 0.0 { [-high, -low] } else { [*low, *high] };
    let late = if *value < 0.0 { "early" } else { "late" };
    let size = Quantity::of(value.abs(), bounds, unit).value;
    Some(format!("the actuators' clock is {size} {late}; shift their stamps"))
}

/// Words the verdict where only the clock was corrected.
fn beside_clock(finding: &Finding) -> String {
    match finding.verdict {
        Verdict::NoEffect | Verdict::Named => "No effect is missing".into(),
        Verdict::FormImperfect | Verdict::Partial => {
            "That explains a part of what the model misses, and the rest has another cause".into()
        }
        _ => of_effects(finding),
    }
}

/// Words the verdict on the effects alone.
fn of_effects(finding: &Finding) -> String {
    let (adverb, what) = (adverb(finding), effects(finding));
    match finding.verdict {
        Verdict::NoEffect => "Nothing is missing: what the model leaves is noise".into(),
        Verdict::Named => format!("The model {adverb} lacks {what}"),
        Verdict::FormImperfect => {
            let left = shown(finding, finding.left.rms);
            format!("The model {adverb} lacks {what}, though not quite of this form ({left} left)")
        }
        Verdict::Partial => match at_bound(finding) {
            Some((effect, parameter)) => format!(
                "A part of what the model misses is {adverb} explained by {what}, which perhaps only imitates the cause: \
                 {parameter} of {effect} rests on its bound",
                parameter = parameter_title(parameter),
                effect = effect_title(effect),
            ),
            None => format!(
                "A part of what the model misses is {adverb} explained by {what}, and the rest by something else"
            ),
        },
        Verdict::UnknownStructure if finding.effects.is_empty() => {
            "The model misses something that its inputs predict, but no known effect explains it".into()
        }
        Verdict::UnknownStructure => {
            format!(
                "The inputs predict what the model misses, but no known effect explains it, {adverb} {what} included"
            )
        }
        Verdict::Event => {
            let event = finding.left.events.first().map_or("something", |event| event.what.as_str());
            format!("Something happened that the inputs do not carry: {event}")
        }
        Verdict::UnmeasuredDisturbance => {
            format!("What the model misses is no noise, but {}", unexplained(&finding.left))
        }
    }
}

/// Words the cause of the remaining residual, as far as the probes support it.
pub fn unexplained(left: &Left) -> &'static str {
    let nothing = |probe: &crate::finding::Probe| !probe.finds();
    match (&left.probe, &left.network) {
        (Some(linear), Some(network)) if nothing(linear) && nothing(network) => "no recorded signal explains it",
        (Some(linear), None) if nothing(linear) => "no linear combination of recorded signals with memory explains it",
        (None, None) => "whether recorded signals explain it could not be tested",
        (None, Some(network)) if nothing(network) => "no network on recorded signals explains it",
        _ => "recorded signals explain a small part of it at most",
    }
}

/// Returns the first effect and parameter that rest on a bound.
fn at_bound(finding: &Finding) -> Option<(&str, &str)> {
    let parameters = finding.effects.iter().flat_map(|effect| effect.parameters.iter().map(move |p| (effect, p)));
    let mut at_bound = parameters.filter(|(_, parameter)| parameter.at_bound);
    at_bound.next().map(|(effect, parameter)| (effect.name.as_str(), parameter.name.as_str()))
}

/// Returns the surest effects first; of equally sure ones the largest.
fn surest_first(finding: &Finding) -> Vec<&FoundEffect> {
    let mut effects: Vec<&FoundEffect> = finding.effects.iter().collect();
    effects.sort_by_key(|effect| std::cmp::Reverse(effect.confidence.level));
    effects
}

/// Returns the adverb of the surest effect.
fn adverb(finding: &Finding) -> &'static str {
    surest_first(finding).first().map_or("", |effect| effect.confidence.level.adverb())
}

/// Lists all effects; the confidence stands before the second and each further one.
fn effects(finding: &Finding) -> String {
    let mut all = surest_first(finding).into_iter();
    let first = all.next().map(describe);
    let more = all.map(|effect| format!("{} {}", effect.confidence.level.adverb(), describe(effect)));
    first.into_iter().chain(more).collect::<Vec<_>>().join(", and ")
}

/// Parameters of an effect that the sentence shows.
const SHOWN: usize = 2;

/// Writes a phrase such as `dead time (delay 218 ms; chosen again in 97 % of resamples)`. Parameters that depend on a
/// signal stand first. Values that cannot be distinguished from zero are left out.
fn describe(effect: &FoundEffect) -> String {
    let mut told: Vec<&FoundParameter> = effect.parameters.iter().filter(|p| p.differs_from_zero()).collect();
    told.sort_by_key(|parameter| parameter.depends_on.is_none());
    let values: Vec<String> = told.iter().take(SHOWN).map(|parameter| value(parameter)).collect();
    let values = match values.is_empty() {
        true => "its values are not determined by these data".into(),
        false => values.join(", ") + if told.len() > SHOWN { ", …" } else { "" },
    };
    let carrier = carried(effect.carrier.as_deref());
    let share = percent(effect.confidence.share);
    format!("{}{carrier} ({values}; chosen again in {share} of resamples)", effect_title(&effect.name))
}

fn value(parameter: &FoundParameter) -> String {
    let quantity = Quantity::of(parameter.value, parameter.interval, &parameter.unit);
    format!("{} {}", parameter_title(&parameter.name), quantity.value)
}

fn capitalized(words: &str) -> String {
    first_letter(words, |letter| letter.to_uppercase().collect())
}

fn uncapitalized(words: &str) -> String {
    first_letter(words, |letter| letter.to_lowercase().collect())
}

fn first_letter(words: &str, change: impl Fn(char) -> String) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| change(first) + letters.as_str())
}

/// Returns the name of the signal that carries an effect, where it has one.
pub fn carrier(instance: &Instance, rig: &Rig) -> Option<String> {
    instance.carrier().signal(rig).map(|signal| signal.name.clone())
}

/// Returns the reason why an effect was not tried.
pub fn why_not(name: &str, prepared: &Prepared) -> String {
    let rig = &prepared.case.rig;
    let can = find(name).is_some_and(|effect| !effect.carriers(rig).is_empty());
    if can {
        return "left out by the configuration, or the trials do not cover what it depends on".into();
    }
    match find(name).map(Effect::site) {
        Some(Site::Load | Site::Marker) if rig.arm.is_none() => {
            "needs a strain model: describe the arm in [arm]".into()
        }
        Some(Site::Load) if rig.throttle.is_none() => "needs a context signal `throttle` that varies".into(),
        Some(Site::Load) if rig.altitude.is_none() => "needs a context signal `altitude` that varies".into(),
        Some(Site::Frame) if name == "base_tilt" && !rig.carried => "needs the carrier's position in [vehicle]".into(),
        Some(Site::Frame) => "needs outputs that are positions x, y, z".into(),
        Some(Site::Output) if name == "joint_gravity" => "needs a signal in rad that varies".into(),
        Some(Site::Actuation) => "needs more actuators that move".into(),
        _ => "needs a signal that varies".into(),
    }
}
