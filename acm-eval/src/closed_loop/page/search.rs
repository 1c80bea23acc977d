//! The search: models on the way, rejected candidates, and effects that were not tried.

use acm_trace::finding::{Candidate, Finding, NotTried, Step};
use maud::{Markup, html};

use super::markup::{Column, cell, folded, heading, table};
use crate::closed_loop::quantity::{common_decimals, percent, plain};
use crate::closed_loop::words::{effect, effect_words, in_unit};

/// Writes the steps, collapsed, then the effects that were not tried.
pub fn section(finding: &Finding) -> Markup {
    let unit = finding.errors.unit.as_str();
    html! {
        (heading("search", "How it was searched", &finding.data))
        p {
            "Effects that the tool knows were fitted one after the other, each at its place in the model. One is added \
            when it makes the model better on development trials that were left out of its fit, by more than its price \
            and by more than chance. The last row is the best candidate that was not accepted."
        }
        @if finding.steps.is_empty() { p { "No steps were recorded." } } @else { (steps(&finding.steps, unit)) }
        (not_tried(&finding.left.not_tried))
    }
}

fn steps(steps: &[Step], unit: &str) -> Markup {
    let decimals = common_decimals(steps.iter().map(|step| step.error));
    let columns: [Column; 7] = [
        ("Model", true),
        ("Error", false),
        ("Gain", false),
        ("By chance", false),
        ("Standard errors", false),
        ("Accepted", true),
        ("Candidates", false),
    ];
    let share = |share: Option<f64>| cell(share.map_or("–".into(), percent));
    let rows: Vec<Vec<Markup>> = steps
        .iter()
        .map(|step| {
            let gain = step.significance.map_or("–".into(), |significance| plain(significance, 1));
            vec![
                effect(&step.model),
                cell(plain(step.error, decimals)),
                share(step.gain),
                share(step.by_chance),
                cell(gain),
                cell(if step.accepted { "yes" } else { "no" }),
                cell(step.candidates.len().to_string()),
            ]
        })
        .collect();
    let count = steps.len();
    let title = format!("{count} model{} on the way, with their candidates", if count == 1 { "" } else { "s" });
    folded(
        &title,
        &html! {
            p.note {
                "Cross-validated root mean square error on development trials" (in_unit(unit)) ". The gain is the \
                share of the mean square that is gone; by chance, the largest gain that any candidate reaches in 99 % of \
                cases where none acts. Standard errors are those of the paired difference over blocks."
            }
            (table("steps", "Models on the way", &columns, &rows))
            @for step in steps.iter().filter(|step| !step.candidates.is_empty()) { (candidates(step)) }
        },
    )
}

fn candidates(step: &Step) -> Markup {
    let decimals = common_decimals(step.candidates.iter().map(|candidate| candidate.error));
    let columns: [Column; 2] = [("Candidate", true), ("Error", false)];
    let row = |candidate: &Candidate| vec![effect(&candidate.name), cell(plain(candidate.error, decimals))];
    let rows: Vec<Vec<Markup>> = step.candidates.iter().map(row).collect();
    let title = format!("Candidates for {}", effect_words(&step.model));
    folded(&title, &table("candidates", &title, &columns, &rows))
}

fn not_tried(not_tried: &[NotTried]) -> Markup {
    html! {
        h3 { "What was not tried, and why" }
        @if not_tried.is_empty() {
            p { "Every effect of the library was tried." }
        } @else {
            p.note { "In a configuration each of them is written with an underscore for a space." }
            ul.names {
                @for (reason, names) in by_reason(not_tried) {
                    li {
                        (reason) ": "
                        (names.iter().map(|name| effect_words(name)).collect::<Vec<_>>().join(", "))
                    }
                }
            }
        }
    }
}

/// Groups names by their reason, in the order in which reasons first appear.
fn by_reason(not_tried: &[NotTried]) -> Vec<(&str, Vec<&str>)> {
    let mut groups: Vec<(&str, Vec<&str>)> = vec![];
    for NotTried { name, reason } in not_tried {
        match groups.iter_mut().find(|(known, _)| known == reason) {
            Some((_, names)) => names.push(name),
            None => groups.push((reason, vec![name])),
        }
    }
    groups
}
