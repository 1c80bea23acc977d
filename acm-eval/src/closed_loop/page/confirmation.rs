//! Confirmation by held-out trials and confidence of effects, in words.

use acm_core::display::{percent, significant, with_symbol};
use acm_trace::finding::{Confirmation, Doubt, Finding, FoundEffect, Level};

use crate::closed_loop::words::effect_words;

/// Returns the confirmation of the model in one word, and its meaning.
pub fn words(finding: &Finding) -> (&'static str, &'static str) {
    match finding.confirmation {
        Confirmation::Confirmed => (
            "confirmed",
            "on held-out trials the error falls, and the 95 % interval of the paired change lies below zero",
        ),
        Confirmation::Open => {
            ("open", "held-out trials do not decide: the 95 % interval of the paired change of their error holds zero")
        }
        Confirmation::Refuted => (
            "refuted",
            "on held-out trials the error rises, and the 95 % interval of the paired change lies above zero; the model is in \
             refuted.json, and there is no model.json",
        ),
        Confirmation::NotTested if finding.adds() => ("not tested", "no trial is held out"),
        Confirmation::NotTested => ("not tested", "nothing was added to the model"),
    }
}

/// Writes `likely: chosen again in 97 % of resamples; not sure, since another effect predicts as well`.
pub fn confidence(effect: &FoundEffect, unit: &str) -> String {
    let reason = |doubt: &Doubt| match (doubt, effect.follows) {
        (Doubt::Followed, Some(rms)) => format!("{} of {}", with_symbol(&significant(rms, 2), unit), doubt.words()),
        _ => doubt.words().to_string(),
    };
    let reasons: Vec<String> = effect.doubts.iter().map(reason).collect();
    let is_told = effect.confidence.level == Level::Likely && !reasons.is_empty();
    let doubt = if is_told { format!("; not sure, since {}", reasons.join(", and ")) } else { String::new() };
    format!(
        "{}: chosen again in {} of resamples{doubt}",
        level(effect.confidence.level),
        percent(effect.confidence.share)
    )
}

/// Writes `sure`, `likely`, `possible`.
pub fn level(level: Level) -> &'static str {
    match level {
        Level::Sure => "sure",
        Level::Likely => "likely",
        Level::Possible => "possible",
    }
}

/// Writes the effects that were chosen instead, `creep 3.0 %, no effect 2.0 %`; empty where there are none.
pub fn replaced_by(effect: &FoundEffect) -> String {
    let name = |name: &str| if name.is_empty() { "no effect".to_string() } else { effect_words(name) };
    effect
        .replaced_by()
        .map(|other| format!("{} {}", name(&other.name), percent(other.share)))
        .collect::<Vec<_>>()
        .join(", ")
}
