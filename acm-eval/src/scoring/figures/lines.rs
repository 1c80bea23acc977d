//! Rows and figures of campaigns of several causes and of small rigs in the terminal.

use acm_datasets::text::terminal::{flush_right, framed};
use comfy_table::{Table, presets};

use super::reliability::Bin;
use super::several::{Figures, SeveralRow};
use super::small_rigs::{RigFigures, RigRow, RigScore};
use crate::scoring::answer::{Answer, Claim, Names};

/// Style of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Framed table, no wider than the terminal.
    Terminal,
    /// Table in Markdown.
    Markdown,
}

impl Look {
    /// Returns an empty table.
    pub fn table(self) -> Table {
        match self {
            Look::Terminal => framed(presets::UTF8_FULL_CONDENSED),
            Look::Markdown => {
                let mut table = Table::new();
                table.load_style(presets::ASCII_MARKDOWN);
                table
            }
        }
    }
}

/// Returns the heading above the lines of campaigns.
pub fn several_heading() -> String {
    format!(
        "{:>8} {:<6} {:<10} {:>6} {:>6} {:>6} {:>6} {:>5} {:>5} {:>5} {:>6}  {}",
        "seed", "design", "kind", "trials", "before", "after", "noise", "found", "wrong", "F1", "s", "claimed"
    )
}

/// Writes one campaign: errors on held-out trials in mm, causes whose absence shows with a sure name, sure names that
/// are wrong.
pub fn several_line(row: &SeveralRow) -> String {
    let names = Names::new(&row.answer);
    format!(
        "{:>8} {:<6} {:<10} {:>6} {:>6.2} {:>6.2} {:>6.2} {:>5} {:>5} {:>5.2} {:>6.1}  {}",
        row.seed,
        row.design.name(),
        row.answer.kind,
        row.trials,
        row.before,
        row.after,
        row.noise,
        format!("{}/{}", names.shown_found, names.shown),
        names.wrong.len(),
        names.f1(),
        row.seconds,
        claimed(&row.answer),
    )
}

/// Returns the heading above the lines of small rigs.
pub fn rig_heading() -> String {
    format!(
        "{:>8} {:<17} {:>10} {:>10} {:>10} {:>6} {:>5} {:>5} {:>6}  {}",
        "seed", "rig", "before", "after", "oracle", "ratio", "found", "wrong", "s", "claimed (true)"
    )
}

/// Writes one rig: errors on held-out trials in the output's SI unit.
pub fn rig_line(row: &RigRow) -> String {
    let names = Names::new(&row.answer);
    let truth: Vec<&str> = row.answer.causes.iter().filter_map(|cause| cause.name.as_deref()).collect();
    format!(
        "{:>8} {:<17} {:>10.3e} {:>10.3e} {:>10.3e} {:>6.2} {:>5} {:>5} {:>6.1}  {} ({})",
        row.seed,
        row.answer.kind,
        row.before,
        row.error,
        row.oracle,
        row.ratio(),
        format!("{}/{}", names.shown_found, names.shown),
        names.wrong.len(),
        row.seconds,
        claimed(&row.answer),
        truth.join(", "),
    )
}

/// Writes `backlash, creep?`: a question mark where a name is not sure.
fn claimed(answer: &Answer) -> String {
    let one = |claim: &Claim| format!("{}{}", claim.name, if claim.sure { "" } else { "?" });
    answer.claims.iter().map(one).collect::<Vec<String>>().join(", ")
}

/// Returns the figures of campaigns of several causes.
pub fn several_table(figures: &Figures, look: Look) -> String {
    names_table("campaigns", figures, look)
}

/// Returns the figures of pooled answers.
pub fn pooled_table(figures: &Figures, look: Look) -> String {
    names_table("campaigns and rigs", figures, look)
}

fn names_table(what: &str, figures: &Figures, look: Look) -> String {
    let mut table = look.table();
    table.set_header(["", ""]);
    table.add_row([what.to_string(), figures.answers.to_string()]);
    for (name, value) in names(figures) {
        table.add_row([name, value]);
    }
    flush_right(&mut table, 1);
    table.to_string()
}

/// Returns the figures of small rigs, a line for each kind, then of their names.
pub fn rig_table(score: &RigScore, look: Look) -> String {
    let mut rigs = look.table();
    rigs.set_header([
        "rig",
        "tried",
        "error ≤ 1.05 oracle",
        "ratio: median, 75, 90 %, worst",
        "names exact",
        "and sure",
    ]);
    let row = |name: &str, figures: &RigFigures| {
        let shares = [figures.exact, figures.exact_and_sure].map(|share| share.to_string());
        let cells = [figures.rigs.to_string(), figures.as_good.to_string(), numbers(&figures.ratio)];
        let cells = cells.into_iter().chain(shares);
        [name.to_string()].into_iter().chain(cells)
    };
    for (name, figures) in &score.kinds {
        rigs.add_row(row(name, figures));
    }
    rigs.add_row(row("one record", &score.records[0]));
    rigs.add_row(row("several records", &score.records[1]));
    rigs.add_row(row("all", &score.all));
    flush_right(&mut rigs, 1);
    format!("{rigs}\n\n{}", names_table("rigs", &score.names, look))
}

fn names(figures: &Figures) -> Vec<(String, String)> {
    let mut rows = vec![
        ("sure names that are right (precision)".into(), figures.precision.to_string()),
        ("separable causes named for sure (recall)".into(), figures.recall.to_string()),
        ("causes whose absence shows named for sure, or an indistinguishable effect".into(), figures.shown.to_string()),
        ("F1 of names: mean".into(), number(figures.f1)),
        ("names exact: all of these, sure or not, and none wrong".into(), figures.exact.to_string()),
        ("sure names exact: all of these, and none wrong".into(), figures.exact_and_sure.to_string()),
        ("sure names that are wrong".into(), figures.sure_wrong.to_string()),
        ("F: worst, 5 %, 10 %, 25 %, median".into(), numbers(&figures.removed)),
        ("F ≥ 0.95".into(), figures.removed_almost_all.to_string()),
        ("95 % intervals that cover the true value".into(), figures.covered.to_string()),
        ("the same where names are exact".into(), figures.covered_where_exact.to_string()),
        ("95 % intervals that reach its tolerance".into(), figures.covered_within_tolerance.to_string()),
        ("width over the ideal one: median".into(), number(figures.width)),
        ("untouched trials: no worse than the best baseline".into(), figures.not_worse.to_string()),
        ("untouched trials: no worse within 1 %".into(), figures.hardly_worse.to_string()),
    ];
    let bins = figures.reliability.iter().filter(|bin| bin.right.of > 0);
    rows.extend(bins.map(reliable));
    let doubted = figures.doubted.iter();
    rows.extend(
        doubted.map(|(doubt, share)| (format!("right, and not sure, since {}", doubt.words()), share.to_string())),
    );
    let wrong = figures.false_names.iter().filter(|(_, share)| share.count > 0);
    rows.extend(wrong.map(|(kind, share)| (format!("{kind}: with a wrong sure name"), share.to_string())));
    rows
}

/// Writes a bin: the fraction that is right, with its 95 % interval.
fn reliable(bin: &Bin) -> (String, String) {
    let name = format!("right where the share is {:.2} and more (mean {})", bin.from, number(bin.mean));
    let interval =
        bin.interval.map_or(String::new(), |[low, high]| format!(" ({:.1}–{:.1} %)", 100.0 * low, 100.0 * high));
    (name, format!("{}{interval}", bin.right))
}

/// Writes one row for each set of figures, so that they can be compared.
pub fn compared(all: &[(String, Figures)], look: Look) -> String {
    let mut table = look.table();
    let columns =
        ["", "tried", "precision", "recall", "exact", "sure and wrong", "F ≥ 0.95", "no worse", "covered", "width"];
    table.set_header(columns);
    for (name, figures) in all {
        table.add_row([
            name.clone(),
            figures.answers.to_string(),
            figures.precision.to_string(),
            figures.recall.to_string(),
            figures.exact.to_string(),
            figures.sure_wrong.to_string(),
            figures.removed_almost_all.to_string(),
            figures.not_worse.to_string(),
            figures.covered.to_string(),
            number(figures.width),
        ]);
    }
    flush_right(&mut table, 1);
    table.to_string()
}

fn number(value: Option<f64>) -> String {
    value.map_or("–".into(), |value| format!("{value:.2}"))
}

fn numbers(values: &[Option<f64>]) -> String {
    values.iter().map(|value| number(*value)).collect::<Vec<_>>().join("  ")
}
