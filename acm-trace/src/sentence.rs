//! The finding in words.

use acm_core::display::Quantity;
use acm_core::effects::instance::{Instance, signal};
use acm_core::effects::{Effect, Site, find};
use acm_core::rig::Rig;

use crate::finding::{Finding, FoundEffect, FoundParameter, Verdict};
use crate::prepared::Prepared;
use crate::title::{effect_title, parameter_title};

/// One sentence for a reader who sees nothing else.
pub fn sentence(finding: &Finding) -> String {
    let errors = &finding.errors;
    let (before, after, display) = (errors.before(), errors.after(), errors.display());
    let best = before.nominal.value.min(before.static_map.value).min(before.recalibrated.value);
    let shown = |value: f64| display.show(value);
    let numbers = format!(
        "error on untouched trials {} → {} (best without it {}, noise {})",
        shown(before.nominal.value),
        shown(after.value),
        shown(best),
        shown(errors.floor()),
    );
    let what = finding.effects.iter().map(describe).collect::<Vec<_>>().join(", and ");
    match finding.verdict {
        Verdict::NoEffect => format!("Nothing is missing: what the model leaves is noise; {numbers}."),
        Verdict::Named => format!("The model lacks {what}; {numbers}."),
        Verdict::FormImperfect => {
            let left = shown(finding.left.rms);
            format!("The model lacks {what}, though not quite of this form ({left} left); {numbers}.")
        }
        Verdict::Partial => match at_bound(finding) {
            Some((effect, parameter)) => format!(
                "A part of what the model misses is explained by {what}, which perhaps only imitates the cause: {parameter} of \
                 {effect} rests on its bound; {numbers}.",
                parameter = parameter_title(parameter),
                effect = effect_title(effect),
            ),
            None => format!(
                "A part of what the model misses is explained by {what}, and the rest by something else; {numbers}."
            ),
        },
        Verdict::UnknownStructure if finding.effects.is_empty() => {
            format!("The model misses something that its inputs predict, but no known effect explains it; {numbers}.")
        }
        Verdict::UnknownStructure => {
            format!(
                "The inputs predict what the model misses, but no known effect explains it, {what} included; {numbers}."
            )
        }
        Verdict::Event => {
            let event = finding.left.events.first().map_or("something", |event| event.what.as_str());
            format!("Something happened that the inputs do not carry: {event}; {numbers}.")
        }
        Verdict::UnmeasuredDisturbance => {
            format!("What the model misses is no noise, but no recorded signal explains it; {numbers}.")
        }
    }
}

/// The first effect and parameter that rest on a bound.
fn at_bound(finding: &Finding) -> Option<(&str, &str)> {
    let parameters = finding.effects.iter().flat_map(|effect| effect.parameters.iter().map(move |p| (effect, p)));
    let mut at_bound = parameters.filter(|(_, parameter)| parameter.at_bound);
    at_bound.next().map(|(effect, parameter)| (effect.name.as_str(), parameter.name.as_str()))
}

/// Parameters of an effect that the sentence shows.
const SHOWN: usize = 2;

/// `dead time (delay 218 ms)`. What depends on a signal stands first. Values that cannot be told from zero are left out.
fn describe(effect: &FoundEffect) -> String {
    let mut told: Vec<&FoundParameter> = effect.parameters.iter().filter(|p| p.differs_from_zero()).collect();
    told.sort_by_key(|parameter| parameter.depends_on.is_none());
    let values: Vec<String> = told.iter().take(SHOWN).map(|parameter| value(parameter)).collect();
    let values = match values.is_empty() {
        true => "its values are not determined by these data".into(),
        false => values.join(", ") + if told.len() > SHOWN { ", …" } else { "" },
    };
    let carrier = effect.carrier.as_ref().map_or(String::new(), |name| format!(" of {name}"));
    format!("{}{carrier} ({values})", effect_title(&effect.name))
}

fn value(parameter: &FoundParameter) -> String {
    let quantity = Quantity::of(parameter.value, parameter.interval, &parameter.unit);
    format!("{} {}", parameter_title(&parameter.name), quantity.value)
}

/// Name of the signal that carries an effect, where it has one.
pub fn carrier(instance: &Instance, rig: &Rig) -> Option<String> {
    signal(instance.carrier(), rig).map(|signal| signal.name.clone())
}

/// Why an effect was not tried.
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
