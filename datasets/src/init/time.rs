//! Column of time and column of trials of a group of tables, by their values first and by their names second.
//!
//! | column of time, in this order | unit |
//! | --- | --- |
//! | a type of time, or dates as text | its own |
//! | rises from row to row, and has a unit of time | that unit |
//! | rises from row to row, and is named as time is | the one in which its steps are plausible |
//! | the only one that rises in even steps, and does not count rows | the one in which its steps are plausible |
//!
//! One row in a hundred may fall where type, unit or name tell: `check` names that row.

use std::collections::BTreeSet;

use super::column::Column;
use super::found::Found;
use super::names;
use crate::ingest::recording::Held;

/// First words of names of time.
const TIME: &str = "t time times zeit zeitstempel timestamp stamp ts seconds secs sec elapsed clock datetime date datum temps tiempo tid";

/// Words of names of trials.
const TRIAL: &str = "trial episode run take sequence seq experiment exp session recording versuch messung lauf";

/// Plausible steps, s.
const STEPS: std::ops::RangeInclusive<f64> = 5e-5..=5.0;

/// Fewer rows than these are no trial.
const ROWS: usize = 10;

/// The time of a table.
#[derive(Debug, Clone)]
pub(super) struct Time {
    pub column: String,
    /// None of a type that carries its own.
    pub unit: Option<String>,
    /// The file does not say the unit.
    pub guessed: bool,
}

/// The column of time; `trial` names the column at whose changes it may start again.
pub(super) fn of(found: &Found, trial: Option<&str>) -> Option<Time> {
    let columns = found.columns();
    let by = columns.iter().find(|column| Some(column.name) == trial);
    let starts = |k: usize| by.map_or(Vec::new(), |column| column.looks[k].starts());
    let rises = |column: &Column, damaged: bool| {
        (0..column.files).all(|k| column.looks.get(k).is_some_and(|look| look.rises(&starts(k), damaged)))
    };
    let said = |column: &Column| column.looks[0].unit.clone().filter(|unit| names::is_time(unit));
    let rank = |column: &Column| match column.looks[0].kind {
        _ if !column.is_sound() => None,
        Held::Text if is_named(column.name) => Some(5),
        Held::Time | Held::Number if !rises(column, true) => None,
        Held::Time => Some(0),
        Held::Number if column.looks[0].dates => Some(1),
        Held::Number if said(column).is_some() => Some(2),
        Held::Number if is_named(column.name) => Some(3),
        Held::Number if rises(column, false) && is_paced(column) => Some(4),
        _ => None,
    };
    let ranked: Vec<(i32, bool, &Column)> =
        columns.iter().filter_map(|column| Some((rank(column)?, !is_named(column.name), column))).collect();
    let (rank, _, column) = ranked.iter().min_by_key(|(rank, is_unnamed, _)| (*rank, *is_unnamed))?;
    if *rank == 4 && ranked.iter().filter(|(other, ..)| *other == 4).count() > 1 {
        return None;
    }
    let unit = match rank {
        0 => None,
        1 => Some("s".into()),
        _ => said(column).or_else(|| Some(likely(column).into())),
    };
    Some(Time { column: column.name.into(), unit, guessed: *rank > 1 && said(column).is_none() })
}

/// Whether its first word is one of time. `T` is a temperature before it is a time.
fn is_named(name: &str) -> bool {
    name != "T" && names::words(name).first().is_some_and(|word| names::has(TIME, word))
}

fn is_paced(column: &Column) -> bool {
    column.looks.iter().all(|look| look.pace().is_some()) && !column.counts_rows()
}

/// The unit in which the usual step is plausible.
fn likely(column: &Column) -> &'static str {
    let step = column.looks[0].pace().unwrap_or(1.0);
    let units = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
    units.into_iter().find(|(_, factor)| STEPS.contains(&(step * factor))).map_or("s", |(unit, _)| unit)
}

/// The column that names trials, and the trials: it has one run of rows for each, and a name that tells, or another column falls
/// just where it changes.
pub(super) fn trials(found: &Found) -> Option<(String, BTreeSet<String>)> {
    let columns = found.columns();
    let restarts = |column: &Column| {
        let own = |k: usize| column.looks[k].starts().split_off(1);
        let fall = |other: &Column| (0..other.files).all(|k| other.looks[k].falls.as_ref() == Some(&own(k)));
        columns.iter().any(|other| other.is_sound() && fall(other))
    };
    let is_named = |column: &Column| names::any(&names::words(column.name), TRIAL);
    let possible = columns.iter().filter(|column| column.is_sound() && column.looks.iter().all(|look| look.is_label()));
    let all: Vec<_> = possible.filter_map(|column| Some((column, names_in(column)?))).collect();
    let (column, names) = all.iter().find(|(c, _)| is_named(c)).or_else(|| all.iter().find(|(c, _)| restarts(c)))?;
    Some((column.name.to_string(), names.clone()))
}

/// The names in a column, where each has one run of rows, and a file has several.
fn names_in(column: &Column) -> Option<BTreeSet<String>> {
    let runs: Vec<_> = column.looks.iter().map(|look| look.runs.as_deref()).collect::<Option<Vec<_>>>()?.concat();
    let rows: usize = column.looks.iter().map(|look| look.rows).sum();
    let names: BTreeSet<String> = runs.iter().map(|(_, name)| name.clone()).filter(|name| !name.is_empty()).collect();
    (names.len() == runs.len() && names.len() > column.files && ROWS * names.len() <= rows).then_some(names)
}
