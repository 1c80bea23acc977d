//! Warnings about signals that jump by a period, with rows, period and remedy.

use std::path::Path;

use crate::checks::plausible::number;
use crate::ingest::periodic::{find, flips};
use crate::text::rows::Rows;
use crate::units::{Dimension, Unit};

/// One column of a trial.
pub(crate) struct Column<'a> {
    /// As the manifest's lists `angles`, `counters` and `quaternions` name it.
    pub name: &'a str,
    pub unit: Option<Unit>,
    /// In that unit; NaN is a missing value.
    pub values: &'a [f64],
}

/// Where the columns stand.
pub(crate) struct Place<'a> {
    pub file: &'a Path,
    pub trial: &'a str,
    /// Table of the manifest that declares them: `[table]`, or a `[[source]]`.
    pub table: String,
    /// Row in the file of a sample.
    pub row: &'a dyn Fn(usize) -> usize,
}

/// Warnings about columns that are not declared as periodic.
pub(crate) fn warnings(columns: &[Column], place: &Place) -> Vec<String> {
    let wraps = columns.iter().filter_map(|column| wraps(column, place));
    wraps.chain(columns.windows(4).filter_map(|four| sign_changes(four, place))).collect()
}

fn wraps(column: &Column, place: &Place) -> Option<String> {
    let turn = column.unit.and_then(|unit| unit.full_turn());
    let found = find(column.values, turn)?;
    let (name, period, table) = (column.name, number(found.period), &place.table);
    let (what, key) = match turn {
        Some(_) => (
            format!("a full turn ({period} {})", column.unit.map_or("", |unit| unit.name)),
            format!("angles = [{name:?}]"),
        ),
        None => (
            format!("{} (2^{})", found.period, found.period.log2()),
            format!("counters = {{ {name:?} = {} }}", found.period),
        ),
    };
    Some(format!(
        "{}: column `{name}` of trial `{}` jumps by {what} between neighbouring samples {} times ({}); write {key} in {table} to unwrap it",
        place.file.display(),
        place.trial,
        found.samples.len(),
        rows(&found.samples, place),
    ))
}

fn sign_changes(four: &[Column], place: &Place) -> Option<String> {
    let [a, b, c, d] = four else { return None };
    let plain = four.iter().all(|column| column.unit.is_none_or(|unit| unit.dimension == Dimension::One));
    let same = four.iter().all(|column| column.values.len() == a.values.len());
    let found = if plain && same { flips([a.values, b.values, c.values, d.values]) } else { Vec::new() };
    let names: Vec<String> = four.iter().map(|column| format!("{:?}", column.name)).collect();
    (!found.is_empty()).then(|| {
        format!(
            "{}: the quaternion {} of trial `{}` changes its sign between neighbouring samples {} times ({}); write \
             quaternions = [[{}]] in {} to keep the sign",
            place.file.display(),
            names.join(", "),
            place.trial,
            found.len(),
            rows(&found, place),
            names.join(", "),
            place.table,
        )
    })
}

fn rows(samples: &[usize], place: &Place) -> Rows {
    samples.iter().map(|i| (place.row)(*i)).collect()
}
