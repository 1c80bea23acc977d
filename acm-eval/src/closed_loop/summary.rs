//! What to print in a terminal when the loop is closed: at most 30 lines of at most 100 letters.

use acm_trace::finding::{Finding, FoundEffect, FoundParameter};
use comfy_table::{Attribute, Cell, CellAlignment, Table, presets};

use super::{
    apart::groups,
    outcome::Outcome,
    quantity::{Quantity, percent, plain, significant},
    verdict::words,
    wrap::wrap,
};

const WIDTH: usize = 100;
/// Lines that each part may take, so that the whole stays on one screen.
const SENTENCE: usize = 4;
const EFFECTS: usize = 8;
const EQUIVALENT: usize = 2;
const NEXT: usize = 2;
const CAUTIONS: usize = 3;

/// The whole summary.
pub fn summary(finding: &Finding) -> String {
    let mut lines: Vec<String> = vec![];
    if finding.data.synthetic {
        lines.push("SYNTHETIC DATA, made by a simulator".into());
    }
    lines.extend(wrap(&finding.sentence, WIDTH, SENTENCE));
    let outcome = Outcome::of(finding);
    let removed = outcome
        .removed
        .map_or(String::new(), |share| format!("; F = {} of the removable error is gone", percent(share)));
    lines.extend(wrap(&format!("Verdict: {}{removed}", words(finding.verdict).label), WIDTH, 1));
    lines.extend(before_and_after(&outcome).to_string().lines().map(String::from));
    lines.extend(effects(finding));
    let others = groups(finding).into_iter().map(|group| group.join(", ")).collect::<Vec<_>>().join("; ");
    if !others.is_empty() {
        lines.extend(hanging("Equally good: ", &others, EQUIVALENT));
    }
    if let Some(experiment) = &finding.next_experiment {
        lines.extend(hanging("Next experiment: ", experiment, NEXT));
    }
    lines.extend(capped(cautions(finding), CAUTIONS, "more on the page"));
    lines.join("\n")
}

fn before_and_after(outcome: &Outcome) -> Table {
    let mut grid = Table::new();
    grid.load_style(presets::UTF8_FULL_CONDENSED);
    grid.set_header([
        "On untouched trials".to_string(),
        format!("error [{}]", outcome.unit.chars().take(20).collect::<String>()),
        "95 % interval".into(),
    ]);
    let number = |value: f64| plain(value, outcome.decimals);
    let right = |words: String| Cell::new(words).set_alignment(CellAlignment::Right);
    for row in outcome.rows() {
        let [low, high] = row.error.interval;
        let label = if row.is_best_before { format!("{} (best before)", row.label) } else { row.label.into() };
        let mut cells =
            [Cell::new(label), right(number(row.error.value)), right(format!("{} to {}", number(low), number(high)))];
        if row.is_after {
            cells = cells.map(|cell| cell.add_attribute(Attribute::Bold));
        }
        grid.add_row(cells);
    }
    grid.add_row([Cell::new("white noise"), right(number(outcome.floor)), Cell::new("")]);
    grid
}

/// A line for each effect, and as many of its parameters as there is room for.
fn effects(finding: &Finding) -> Vec<String> {
    let shown = &finding.effects[..finding.effects.len().min(EFFECTS - 1)];
    let room = (EFFECTS / shown.len().max(1)).saturating_sub(1);
    let mut lines: Vec<String> = shown.iter().flat_map(|effect| one(effect, finding.errors.unit(), room)).collect();
    if shown.len() < finding.effects.len() {
        lines.push(format!("… {} more effects on the page", finding.effects.len() - shown.len()));
    }
    lines
}

fn one(effect: &FoundEffect, unit: &str, room: usize) -> Vec<String> {
    let size = significant(effect.size, 3);
    let title = format!("{}: {}; moves the outputs by {size} {unit}", effect.name, effect.meaning);
    let mut lines = wrap(&title, WIDTH, 1);
    if room > 0 {
        lines.extend(capped(effect.parameters.iter().map(parameter).collect(), room, "more parameters on the page"));
    }
    lines
}

fn parameter(parameter: &FoundParameter) -> String {
    let quantity = Quantity::of(parameter.value, parameter.interval, &parameter.unit);
    let name: String = parameter.name.chars().take(40).collect();
    let line = format!("  {name} = {}, 95 %: {}", quantity.value, quantity.interval);
    line.chars().take(WIDTH).collect()
}

fn cautions(finding: &Finding) -> Vec<String> {
    finding.cautions.iter().flat_map(|caution| wrap(&format!("Caution: {caution}"), WIDTH, 1)).collect()
}

/// At most so many lines; the last then says how many there are more.
fn capped(mut lines: Vec<String>, most: usize, where_else: &str) -> Vec<String> {
    if lines.len() > most {
        let more = lines.len() - (most - 1);
        lines.truncate(most - 1);
        lines.push(format!("  … {more} {where_else}"));
    }
    lines
}

/// A title, and words that are indented below it where they need more than one line.
pub fn hanging(title: &str, words: &str, most: usize) -> Vec<String> {
    let lines = wrap(&format!("{title}{words}"), WIDTH - 2, most);
    lines.into_iter().enumerate().map(|(index, line)| if index == 0 { line } else { format!("  {line}") }).collect()
}
