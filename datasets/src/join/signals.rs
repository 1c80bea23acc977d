//! Wanted columns of one file of a source, on its own clock.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::jump;
use super::series::Series;
use crate::error::{DataError, Problems};
use crate::formats::{self, Format, Keep};
use crate::ingest::periodic::unwrap;
use crate::ingest::recording::{DataFile, Recording, Ticks, TimeColumn, Wanted};
use crate::ingest::stamps::Stamps;
use crate::manifest::{Source, Time};
use crate::units::{Dimension, Unit};

/// The columns of one file, by their names in it.
#[derive(Debug, Default)]
pub struct Signals {
    /// Format that it was read as.
    pub format: Option<Format>,
    /// Columns with the index of their axis; NaN is an empty cell.
    pub columns: BTreeMap<String, (usize, Vec<f64>)>,
    /// Instants that columns share, s, increasing.
    pub axes: Vec<Axis>,
    /// Instant of time 0 where the file has dates, ns since 1970.
    pub origin: Option<i128>,
    /// Units of columns, as far as the file says them.
    pub units: BTreeMap<String, String>,
    /// Recognized properties and lost parts.
    pub notes: Vec<String>,
}

/// Instants that columns share.
#[derive(Debug, Default)]
pub struct Axis {
    /// s, increasing.
    pub time: Vec<f64>,
    /// Row of the first sample.
    pub first_row: usize,
}

impl Signals {
    /// The samples of a column that are there.
    pub fn series(&self, column: &str) -> Option<Series> {
        let (axis, values) = self.columns.get(column)?;
        Some(Series::new(&self.axes.get(*axis)?.time, values))
    }
}

/// Reads the columns of a source from one of its files.
pub fn read(path: &Path, source: &Source, columns: &BTreeSet<String>) -> Result<Signals, DataError> {
    let format = match source.format {
        Some(format) => format,
        None => formats::recognise(path)?.ok_or_else(|| DataError::UnknownExtension { path: path.to_path_buf() })?,
    };
    match format.is_table() {
        true => table(path, source, format, columns),
        false => take(path, source, format, columns),
    }
}

/// Motion capture and logs.
fn take(path: &Path, source: &Source, format: Format, columns: &BTreeSet<String>) -> Result<Signals, DataError> {
    let take = formats::read(path, format, Keep::Named(columns))?;
    let mut signals = Signals { format: Some(format), notes: take.notes.clone(), ..Signals::default() };
    signals.notes.extend(take.lost.iter().map(|what| format!("LOST: {what}")));
    let skipped: Vec<&str> = take.notes.iter().filter(|note| note.contains("skipped")).map(String::as_str).collect();
    missing(path, columns, take.groups.iter().flat_map(|g| g.columns.iter().map(|c| c.name.as_str())), &skipped)?;
    for group in take.groups {
        let kept: Vec<formats::Column> = group.columns.into_iter().filter(|c| columns.contains(&c.name)).collect();
        if kept.is_empty() {
            continue;
        }
        let log = matches!(format, Format::Ulog | Format::Mcap);
        let row = |i: usize| group.first_row + i;
        if !log {
            check_order((path, source), "time", &group.time, None, None, &row)?;
        }
        let order = jump::in_order(&group.time, log).map_err(|jump| jump.of(path, &source.name, group.first_row))?;
        if order.len() < group.time.len() {
            let (name, count) = (&group.name, group.time.len() - order.len());
            signals.notes.push(format!("`{name}`: {count} samples whose time goes back or jumps are left out"));
        }
        let axis = signals.axes.len();
        let time = order.iter().map(|i| group.time[*i]).collect();
        signals.axes.push(Axis { time, first_row: group.first_row });
        for column in kept {
            signals.units.extend(column.unit.map(|unit| (column.name.clone(), unit.to_string())));
            let values = order.iter().map(|i| column.values[*i]).collect();
            signals.columns.insert(column.name, (axis, values));
        }
    }
    Ok(signals)
}

/// Tables, whose time the manifest names.
fn table(path: &Path, source: &Source, format: Format, columns: &BTreeSet<String>) -> Result<Signals, DataError> {
    let time = &source.time;
    if *time == Time::default() {
        let what = format!("it is a table ({}), and its time is not declared", format.name());
        let remedy = "write time = { column = \"t\", unit = \"s\" } or { rate_hz = 20.0 } in its [[source]]";
        return Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy });
    }
    let counts =
        time.unit.as_deref().and_then(|u| Unit::parse(u).ok()).is_some_and(|u| u.dimension == Dimension::Sample);
    let mut numbers: BTreeMap<String, bool> = columns.iter().map(|column| (column.clone(), true)).collect();
    numbers.extend(time.column.iter().map(|column| (column.clone(), false)));
    let column = |column: &String| TimeColumn { column: column.clone(), unit: time.unit.clone(), counts };
    let first = |text: &Option<String>| text.as_deref().and_then(|text| text.chars().next());
    let (separator, decimal) = (first(&source.separator), first(&source.decimal));
    let wanted = Wanted { numbers, label: None, time: time.column.as_ref().map(column), separator, decimal };
    let mut problems = Vec::new();
    let (file, _) = DataFile::open(path, Some(format), &wanted, false)?;
    let (units, notes) = (file.units(), file.notes().to_vec());
    clock_unit(path, time, &units)?;
    let mut signals = Signals { format: Some(format), units, notes, ..Signals::default() };
    let read = file.whole(&mut problems);
    Problems(problems).into_result()?;
    let Some(mut read) = read else { return Err(DataError::NoRows { path: path.to_path_buf() }) };
    signals.notes.extend(read.said());
    let counter = time.column.as_ref().and_then(|column| Some((column, source.counters.get(column)?)));
    if let Some((column, range)) = counter {
        read.numbers.get_mut(column).into_iter().for_each(|values| unwrap(values, *range));
    }
    let seconds = seconds(&read, time, counts);
    signals.origin = read.ticks.as_ref().and_then(Ticks::origin);
    let name = time.column.as_deref().unwrap_or("time");
    let (raw, row) = (read.numbers.get(name).filter(|_| read.ticks.is_none()), |i| read.row(i));
    check_order((path, source), name, &seconds, raw.map(Vec::as_slice), read.ticks.as_ref(), &row)?;
    signals.axes.push(Axis { time: seconds, first_row: read.first_row });
    for column in columns {
        let values = read.numbers.remove(column).unwrap_or_default();
        signals.columns.insert(column.clone(), (0, values));
    }
    Ok(signals)
}

/// A row of units may say another unit of time than the manifest.
fn clock_unit(path: &Path, time: &Time, units: &BTreeMap<String, String>) -> Result<(), DataError> {
    let Some((column, unit)) = time.column.as_ref().zip(time.unit.as_ref()) else { return Ok(()) };
    DataError::other_unit(path, column, units.get(column), unit).map_or(Ok(()), Err)
}

fn seconds(read: &Recording, time: &Time, counts: bool) -> Vec<f64> {
    if let Some(ticks) = &read.ticks {
        return ticks.seconds(&(0..read.rows).collect::<Vec<_>>());
    }
    let rate = time.rate_hz.unwrap_or(1.0);
    let Some(column) = &time.column else { return (0..read.rows).map(|i| i as f64 / rate).collect() };
    let unit = time.unit.as_deref().and_then(|unit| Unit::parse(unit).ok());
    let to_seconds = |value: &f64| match unit {
        _ if counts => value / rate,
        Some(unit) => unit.to_si(*value),
        None => *value,
    };
    read.numbers.get(column).into_iter().flatten().map(to_seconds).collect()
}

/// Time of a table increases and does not jump; a counter that starts again is no jump.
fn check_order(
    (path, source): (&Path, &Source),
    column: &str,
    time: &[f64],
    raw: Option<&[f64]>,
    ticks: Option<&Ticks>,
    row: &dyn Fn(usize) -> usize,
) -> Result<(), DataError> {
    let (index, repeats) = (&|i| i, &|_, _| false);
    let stamps = Stamps { path, column, time, raw, ticks, row, index, repeats };
    if !stamps.starts_again() {
        jump::in_order(time, false).map_err(|jump| jump.of(path, &source.name, row(0)))?;
    }
    Problems(stamps.check()).into_result()
}

/// Columns that the file does not have.
fn missing<'a>(
    path: &Path,
    columns: &BTreeSet<String>,
    known: impl Iterator<Item = &'a str>,
    skipped: &[&str],
) -> Result<(), DataError> {
    let known: Vec<&str> = known.collect();
    let problem = |column: &String| {
        let meant = crate::text::spelling::meant(column, known.iter().copied());
        let meant = meant.map_or(String::new(), |name| format!(" (did you mean `{name}`?)"));
        let first: Vec<String> = known.iter().take(40).map(|name| format!("`{name}`")).collect();
        let more = if known.len() > 40 { format!(" and {} more", known.len() - 40) } else { String::new() };
        let skipped = if skipped.is_empty() { String::new() } else { format!(" ({})", skipped.join("; ")) };
        let known = first.join(" ") + &more + &meant + &skipped;
        DataError::MissingColumn { path: path.to_path_buf(), column: column.clone(), known }
    };
    let lacking = columns.iter().filter(|column| !known.contains(&column.as_str())).map(problem);
    Problems(lacking.collect()).into_result()
}
