//! Rows and figures in the terminal.

use acm_datasets::text::terminal::flush_right;
use acm_sim::twin::undeclared::{Class, Since};
use acm_trace::finding::Verdict;

use super::row::{Row, Top};
use super::score::{Score, Summary};
use crate::scoring::figures::Look;

/// Returns the heading above the lines.
pub fn heading() -> String {
    format!(
        "{:>8} {:<6} {:<24} {:<6} {:<22} {:>6} {:>6} {:>6} {:>6} {:<5} {:<3} {:>5}  {}",
        "seed", "design", "kind", "since", "verdict", "before", "after", "floor", "F", "top-1", "set", "s", "found"
    )
}

/// Writes one campaign on one line: errors in mm, `before` the best of the three.
pub fn line(row: &Row) -> String {
    let best = row.before.into_iter().fold(f64::INFINITY, f64::min);
    let removed = row.removed.map_or("–".into(), |share| format!("{share:.3}"));
    format!(
        "{:>8} {:<6} {:<24} {:<6} {:<22} {:>6.2} {:>6.2} {:>6.2} {:>6} {:<5} {:<3} {:>5.1}  {}",
        row.seed,
        row.design.name(),
        row.kind,
        since(row.since),
        verdict(row.verdict),
        best,
        row.after,
        row.floor,
        removed,
        top(row),
        set(row),
        row.seconds,
        found(row),
    )
}

fn since(since: Option<Since>) -> &'static str {
    match since {
        None => "–",
        Some(Since::Start) => "start",
        Some(Since::AfterCalibration) => "after",
        Some(Since::OneTrial) => "once",
    }
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoEffect => "no effect",
        Verdict::Named => "named",
        Verdict::FormImperfect => "named, form imperfect",
        Verdict::Partial => "partial",
        Verdict::UnknownStructure => "unknown structure",
        Verdict::Event => "event",
        Verdict::UnmeasuredDisturbance => "unmeasured",
    }
}

/// Writes `ok`, `alias`, `WRONG`, `none`; where nothing should be named: `quiet`, or `FALSE`.
fn top(row: &Row) -> &'static str {
    if row.is_known() && !row.without_own {
        return match row.top {
            Top::Name => "ok",
            Top::Alias => "alias",
            Top::Wrong => "WRONG",
            Top::None => "none",
        };
    }
    match (row.names(), row.top) {
        (true, Top::Name | Top::Alias) => "alias",
        (true, _) => "FALSE",
        (false, _) if row.class == Class::Null && !row.found.is_empty() => "spur.",
        (false, _) => "quiet",
    }
}

fn set(row: &Row) -> &'static str {
    match row.is_known() && !row.without_own {
        true if row.in_set == row.truth.len() => "yes",
        true if row.in_set > 0 => "one",
        true => "NO",
        false => "",
    }
}

/// Writes `backlash = dry_friction, creep`: the found effects, the first with those that explain as much.
fn found(row: &Row) -> String {
    let Some((first, more)) = row.found.split_first() else { return String::new() };
    let others = row.equivalent.iter().filter(|name| *name != first).map(|name| format!(" = {name}"));
    let more = more.iter().map(|name| format!(", {name}"));
    [first.clone()].into_iter().chain(others).chain(more).collect()
}

/// One figure: its name, and its text for a summary.
type Figure = (&'static str, fn(&Summary) -> String);

const FIGURES: &[Figure] = &[
    ("campaigns", |s| s.campaigns.to_string()),
    ("top-1: true name", |s| s.top_by_name.to_string()),
    ("top-1: or an alias of mutual share ≥ 0.95", |s| s.top_at[0].to_string()),
    ("top-1: or an alias of mutual share ≥ 0.98", |s| s.top_at[1].to_string()),
    ("top-1: or an alias of mutual share ≥ 0.99", |s| s.top_at[2].to_string()),
    ("truth in set: true name", |s| s.in_set_by_name.to_string()),
    ("truth in set: or an alias", |s| s.in_set.to_string()),
    ("mean size of the set", |s| number(s.set_size)),
    ("pairs: both found", |s| s.pairs_both.to_string()),
    ("pairs: at least one found", |s| s.pairs_one.to_string()),
    ("nulls: any name", |s| s.any_name.to_string()),
    ("nulls: any name, first 200", |s| s.any_name_first.to_string()),
    ("nulls: a sure name", |s| s.false_names.to_string()),
    ("nulls: names that are not sure", |s| s.spurious_partials.to_string()),
    ("nulls: \"no effect\"", |s| s.nulls_clean.to_string()),
    ("outside the library: abstained", |s| s.outside_abstained.to_string()),
    ("outside the library: a sure wrong name", |s| s.outside_wrong.to_string()),
    ("own entry removed: abstained", |s| s.without_own_abstained.to_string()),
    ("own entry removed: a sure wrong name", |s| s.without_own_wrong.to_string()),
    ("untouched trials: no worse than the best baseline", |s| s.not_worse.to_string()),
    ("untouched trials: no worse within 1 %", |s| s.hardly_worse.to_string()),
    ("untouched trials: worst error over the best baseline's", |s| s.worst.map_or("–".into(), |r| format!("{r:.3}"))),
    ("F ≥ 0.95", |s| s.removed_almost_all.to_string()),
    ("F: worst, 5 %, 10 %, 25 %, median", |s| numbers(&s.removed)),
    ("F over the true noise ≥ 0.95", |s| s.removed_almost_all_over_true_floor.to_string()),
    ("F over the true noise: the same quantiles", |s| numbers(&s.removed_over_true_floor)),
    ("parameters within the truth's tolerance", |s| s.within_tolerance.to_string()),
    ("absolute error over tolerance: median, 90 %", |s| numbers(&s.parameter_error)),
    ("95 % intervals that cover the true value", |s| s.covered.to_string()),
    ("95 % intervals that cover the library's value without noise", |s| s.covered_without_noise.to_string()),
    ("95 % intervals that reach its tolerance", |s| s.covered_within_tolerance.to_string()),
    ("seconds: median, longest", |s| numbers(&s.seconds)),
];

fn number(value: Option<f64>) -> String {
    value.map_or("–".into(), |value| format!("{value:.2}"))
}

fn numbers(values: &[Option<f64>]) -> String {
    match values.iter().all(Option::is_none) {
        true => "–".into(),
        false => values.iter().map(|value| number(*value)).collect::<Vec<_>>().join("  "),
    }
}

/// Writes all figures, a column for each design and one for all; empty lines are left out.
pub fn table(score: &Score, look: Look) -> String {
    let mut columns: Vec<(&str, &Summary)> = score.designs.iter().map(|(d, summary)| (d.name(), summary)).collect();
    if columns.len() != 1 {
        columns.push(("all", &score.all));
    }
    let mut table = look.table();
    table.set_header([""].into_iter().chain(columns.iter().map(|(name, _)| *name)));
    for (name, show) in FIGURES {
        let cells: Vec<String> = columns.iter().map(|(_, summary)| show(summary)).collect();
        if cells.iter().any(|cell| cell != "–") {
            table.add_row([(*name).to_string()].into_iter().chain(cells));
        }
    }
    flush_right(&mut table, 1);
    table.to_string()
}
