//! Column of time and column of trials of a group of tables, by their values first and by their names second.
//!
//! | column of time, in this order | unit |
//! | --- | --- |
//! | a type of time, or dates as text | its own |
//! | rises from row to row, and has a unit of time | that unit |
//! | rises from row to row, and is named as time is | the one in which its steps are plausible |
//! | the only one that rises in even steps, and does not count rows | the one in which its steps are plausible |
//! | other text that is named as time is: `check` names its rows | s |
//!
//! One row in a hundred may fall where type, unit or name tell: `check` names that row.

use std::collections::BTreeSet;
use std::path::Path;

use super::column::Column;
use super::found::{File, Found, Time};
use super::look;
use super::names;
use crate::ingest::recording::Held;
use crate::units::Unit;

/// First words of names of time.
const TIME: &str = "t time times zeit zeitstempel timestamp stamp ts seconds secs sec elapsed clock datetime date datum temps tiempo tid";

/// Words of names of trials.
const TRIAL: &str = "trial episode run take sequence seq experiment exp session recording versuch messung lauf";

/// Plausible steps, s.
const STEPS: std::ops::RangeInclusive<f64> = 5e-5..=5.0;

/// Fewer rows than these are no trial.
const ROWS: usize = 10;

/// The column of time; it may start again where the trial changes.
pub(super) fn of(found: &Found) -> Option<Time> {
    let columns = found.columns();
    let by = columns.iter().find(|column| found.by.as_ref().is_some_and(|(by, _)| column.name == by));
    let rises = |column: &Column, damaged: bool| {
        let starts = |k: usize| by.map_or(&[][..], |by| &by.looks[k].changes);
        column.looks.iter().enumerate().all(|(k, look)| look.rises(starts(k), damaged))
    };
    let rank = |column: &Column| match column.looks[0].kind {
        _ if !found.format.is_table() || !column.is_sound() => None,
        Held::Text if is_named(column.name) => Some(4),
        Held::Time | Held::Number if !rises(column, true) => None,
        Held::Time => Some(0),
        Held::Number if unit(column).is_some() => Some(1),
        Held::Number if is_named(column.name) => Some(2),
        Held::Number if rises(column, false) && column.is_paced() => Some(3),
        _ => None,
    };
    let ranked: Vec<_> = columns.iter().filter_map(|column| Some((rank(column)?, column))).collect();
    let (rank, column) = *ranked.iter().min_by_key(|(rank, column)| (*rank, !is_named(column.name)))?;
    let is_one_of_several = ranked.iter().filter(|(other, _)| *other == rank).count() > 1;
    (rank != 3 || !is_one_of_several).then(|| time(column, rank == 0))
}

fn time(column: &Column, is_typed: bool) -> Time {
    let said = if is_typed { Some("s".into()) } else { unit(column) };
    let unit = said.clone().unwrap_or_else(|| likely(column).into());
    let factor = Unit::parse(&unit).map_or(1.0, |unit| unit.factor());
    Time {
        column: column.name.into(),
        guessed: said.is_none(),
        duration: column.looks.iter().map(|look| factor * (look.high - look.low)).sum(),
        unit: Some(unit).filter(|_| !is_typed),
    }
}

/// Its unit of time, by the file or by its name.
fn unit(column: &Column) -> Option<String> {
    column.looks[0].unit.clone().filter(|unit| names::is_time(unit))
}

/// Whether its first word is one of time. `T` is a temperature before it is a time.
fn is_named(name: &str) -> bool {
    name != "T" && names::words(name).first().is_some_and(|word| names::has(TIME, word))
}

/// The unit in which the usual step is plausible.
fn likely(column: &Column) -> &'static str {
    let step = column.looks[0].pace().unwrap_or(1.0);
    let units = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
    units.into_iter().find(|(_, factor)| STEPS.contains(&(step * factor))).map_or("s", |(unit, _)| unit)
}

/// The column that names trials, and the trials: it has one run of rows for each, and a name that tells, or another column falls
/// just where it changes.
pub(super) fn trials(folder: &Path, found: &Found) -> Option<(String, Vec<String>)> {
    let columns = found.columns();
    let is_named = |column: &Column| names::any(&names::words(column.name), TRIAL);
    let restarts = |column: &Column| {
        let falls = |other: &Column| (0..other.files).all(|k| other.looks[k].falls == column.looks[k].changes);
        columns.iter().any(|other| other.is_sound() && falls(other))
    };
    let is_label = |column: &&Column| column.is_sound() && column.looks.iter().all(|look| look.is_label());
    let mut possible: Vec<&Column> = columns.iter().filter(is_label).collect();
    possible.retain(|column| is_named(column) || restarts(column));
    possible.sort_by_key(|column| !is_named(column));
    possible.into_iter().find_map(|column| Some((column.name.to_string(), names_in(folder, found, column)?)))
}

/// The names in a column, where each has one run of rows, and a file has several.
fn names_in(folder: &Path, found: &Found, column: &Column) -> Option<Vec<String>> {
    let runs: usize = column.looks.iter().map(|look| 1 + look.changes.len()).sum();
    if runs <= column.files || ROWS * runs > found.rows() {
        return None;
    }
    let labels = |file: &File| look::labels(&folder.join(&file.path), file.format, column.name);
    let mut names: Vec<String> = found.files.iter().flat_map(labels).collect();
    names.dedup();
    let distinct: BTreeSet<&String> = names.iter().filter(|name| !name.is_empty()).collect();
    (distinct.len() == names.len()).then_some(names)
}
