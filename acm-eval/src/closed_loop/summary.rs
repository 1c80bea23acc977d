//! Terminal summary of a closed loop, wrapped to the terminal's width.

use acm_core::display::{labelled, with_symbol};
use acm_datasets::text::terminal::{cell, flush_right, framed, paragraph};
use acm_trace::finding::{Finding, FoundEffect, FoundParameter, title::parameter_title};
use comfy_table::{Table, presets};

use super::outcome::Outcome;
use super::page::apart::groups;
use super::page::confirmation::{self, confidence, replaced_by};
use super::page::verdict::words;
use super::quantity::{of_parameter, percent, plain, significant};
use super::readable::readable;

/// Returns the whole summary.
pub fn summary(finding: &Finding) -> String {
    let finding = &readable(finding);
    let outcome = Outcome::of(finding);
    let mut parts: Vec<String> = vec![];
    if finding.data.synthetic {
        parts.push("SYNTHETIC DATA, made by a simulator".into());
    }
    parts.push(paragraph(&finding.sentence, ""));
    parts.push(paragraph(&verdict(finding, &outcome), "  "));
    let (confirmed, means) = confirmation::words(finding);
    parts.push(paragraph(&format!("Held-out trials: {confirmed}; {means}"), "  "));
    parts.push(before_and_after(&outcome).to_string());
    parts.extend(finding.effects.iter().map(|effect| one(effect, &finding.errors.unit)));
    let others = groups(finding).into_iter().map(|group| group.join(", ")).collect::<Vec<_>>().join("; ");
    if !others.is_empty() {
        parts.push(paragraph(&format!("Equally good: {others}"), "  "));
    }
    parts.extend(finding.next_experiment.iter().map(|next| paragraph(&format!("Next experiment: {next}"), "  ")));
    parts.extend(finding.cautions.iter().map(|caution| paragraph(&format!("Caution: {caution}"), "  ")));
    parts.join("\n")
}

fn verdict(finding: &Finding, outcome: &Outcome) -> String {
    let removed = |share| format!("; F = {} of the removable error is gone", percent(share));
    format!("Verdict: {}{}", words(finding).label, outcome.removed.map_or(String::new(), removed))
}

fn before_and_after(outcome: &Outcome) -> Table {
    let mut table = framed(presets::UTF8_FULL_CONDENSED);
    table.set_header(["On held-out trials", &labelled("error", outcome.unit), "95 % interval"]);
    let number = |value: f64| plain(value, outcome.decimals);
    for row in outcome.rows() {
        let [low, high] = row.error.interval;
        let texts = [row.name(), number(row.error.value), format!("{} to {}", number(low), number(high))];
        table.add_row(texts.map(|text| cell(text, row.is_after)));
    }
    table.add_row(["white noise".into(), significant(outcome.noise, 2), String::new()]);
    flush_right(&mut table, 1);
    table
}

/// Returns the text of an effect: its meaning, and a line for each of its parameters.
fn one(effect: &FoundEffect, unit: &str) -> String {
    let size = with_symbol(&significant(effect.size, 3), unit);
    let title = paragraph(&format!("{}: {}; moves the outputs by {size}", effect.name, effect.meaning), "  ");
    let replaced = replaced_by(effect);
    let instead = if replaced.is_empty() { String::new() } else { format!("; else {replaced}") };
    let sure = paragraph(&format!("  {}{instead}", confidence(effect, unit)), "    ");
    [title, sure].into_iter().chain(effect.parameters.iter().map(parameter)).collect::<Vec<_>>().join("\n")
}

fn parameter(parameter: &FoundParameter) -> String {
    let (quantity, name) = (of_parameter(parameter), parameter_title(&parameter.name));
    match parameter.undetermined {
        true => paragraph(&format!("  {name}: {}", quantity.value), "    "),
        false => paragraph(&format!("  {name} = {}, 95 %: {}", quantity.value, quantity.interval), "    "),
    }
}
