//! Effects that could not be distinguished, and experiments that would.

use acm_trace::finding::Finding;
use maud::{Markup, html};

use super::markup::heading;
use crate::closed_loop::words::effect_words;

/// Writes the names that explain as much, with their meaning, and the recommended recordings.
pub fn section(finding: &Finding) -> Markup {
    html! {
        (heading("apart", "Effects that could not be distinguished", &finding.data))
        (equivalent(finding))
        @if let Some(experiment) = &finding.next_experiment {
            div.next { b { "Next experiment: " } (experiment) }
        } @else {
            p { "No further experiment is proposed." }
        }
    }
}

fn equivalent(finding: &Finding) -> Markup {
    let groups = groups(finding);
    html! {
        @if finding.effects.is_empty() && groups.is_empty() {
            p { "No effect was named, so there is none to mistake for another." }
        } @else if groups.is_empty() {
            p { "No other effect of the library explains these trials as well." }
        }
        @for group in &groups {
            p { "These explain the trials equally well; the first has the fewest parameters:" }
            ul.names {
                @for name in group.iter() {
                    (member(name))
                }
            }
        }
    }
}

/// Writes an effect in a list: its meaning and its name.
pub fn member(name: &str) -> Markup {
    let words = effect_words(name);
    html! {
        li {
            b { (words) } @if let Some(meaning) = meaning(name) { ": " (meaning) }
            @if words != name { " " code.identifier { (name) } }
        }
    }
}

/// Returns the sets of two or more names that explain as much, each once.
pub fn groups(finding: &Finding) -> Vec<&[String]> {
    let own = finding.effects.iter().map(|effect| effect.equivalent.as_slice());
    let mut groups: Vec<&[String]> = vec![];
    for group in std::iter::once(finding.equivalent.as_slice()).chain(own) {
        if group.len() > 1 && !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups
}

/// Returns the meaning of an effect's name, which may be followed by its carrier.
fn meaning(name: &str) -> Option<&'static str> {
    let word = name.split(|c: char| c.is_whitespace() || "([,:".contains(c)).next()?;
    Some(acm_core::effects::find(word)?.meaning())
}
