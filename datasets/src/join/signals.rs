//! Wanted columns of one file of a source, on its own clock.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::series::Series;
use crate::error::{DataError, More, Problems};
use crate::formats::{self, Format, Keep};
use crate::ingest::recording::dialect::{self, Plain, Told};
use crate::ingest::recording::{self, Content, TimeColumn, Wanted};
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
    missing(path, columns, take.groups.iter().flat_map(|g| g.columns.iter().map(|c| c.name.as_str())))?;
    for group in take.groups {
        let kept: Vec<formats::Column> = group.columns.into_iter().filter(|c| columns.contains(&c.name)).collect();
        if kept.is_empty() {
            continue;
        }
        let log = matches!(format, Format::Ulog | Format::Mcap);
        let order = increasing(&group.time);
        if !log && order.len() < group.time.len() {
            return Err(disordered(path, source, &group.time, group.first_row));
        }
        if order.len() < group.time.len() {
            let (name, count) = (&group.name, group.time.len() - order.len());
            signals.notes.push(format!("`{name}`: {count} samples that go back in time are left out"));
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
    let mut time = source.time.clone();
    if time == Time::default() {
        let what = format!("it is a table ({}), and its time is not declared", format.name());
        let remedy = "write time = { column = \"t\", unit = \"s\" } or { rate_hz = 20.0 } in its [[source]]";
        return Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy });
    }
    let mut counts =
        time.unit.as_deref().and_then(|u| Unit::parse(u).ok()).is_some_and(|u| u.dimension == Dimension::Sample);
    let mut numbers: BTreeMap<String, bool> = columns.iter().map(|column| (column.clone(), true)).collect();
    numbers.extend(time.column.iter().map(|column| (column.clone(), false)));
    let column = |column: &String| TimeColumn { column: column.clone(), unit: time.unit.clone(), counts };
    let mut wanted = Wanted { numbers, label: None, time: time.column.as_ref().map(column), separator: b',' };
    let (mut problems, mut signals) = (Vec::new(), Signals { format: Some(format), ..Signals::default() });
    let read = match format {
        Format::Csv => {
            let plain = plain(path, source)?;
            signals.notes.clone_from(&plain.notes);
            signals.units.clone_from(&plain.units);
            if plain.instants {
                time = Time { unit: None, rate_hz: None, ..time };
                counts = false;
                wanted.time.iter_mut().for_each(|time| time.unit = Some("s".into()));
            }
            clock_unit(path, &time, &plain)?;
            recording::read_plain(path, plain, &wanted, &mut problems)
        }
        _ => recording::read(path, &wanted, &mut problems),
    };
    Problems(problems).into_result()?;
    let Some(mut read) = read else { return Err(DataError::NoRows { path: path.to_path_buf() }) };
    let seconds = seconds(&read, &time, counts);
    if increasing(&seconds).len() < seconds.len() {
        return Err(disordered(path, source, &seconds, read.first_row));
    }
    signals.axes.push(Axis { time: seconds, first_row: read.first_row });
    for column in columns {
        let values = read.numbers.remove(column).unwrap_or_default();
        signals.columns.insert(column.clone(), (0, values));
    }
    Ok(signals)
}

/// The file in the one form of CSV.
fn plain(path: &Path, source: &Source) -> Result<Plain, DataError> {
    let bytes = match Content::held(path)? {
        Content::Held(bytes) => bytes,
        Content::OnDisk(..) => Vec::new(),
    };
    let first = |text: &Option<String>| text.as_deref().and_then(|text| text.chars().next());
    let (separator, decimal) = (first(&source.separator), first(&source.decimal));
    dialect::plain(path, bytes, &Told { separator, decimal, time: source.time.column.clone() })
}

/// A row of units may say another unit of time than the manifest.
fn clock_unit(path: &Path, time: &Time, plain: &Plain) -> Result<(), DataError> {
    let of_row = time.column.as_ref().and_then(|column| plain.units.get(column));
    match (of_row, &time.unit) {
        (Some(row), Some(told)) if row != told && told != "sample" && !plain.instants => {
            let what = format!("the row of units has the time in {row:?}, and the manifest in {told:?}");
            let (path, remedy) = (path.to_path_buf(), "correct `time` in its [[source]], or the row");
            Err(DataError::BadText { path, row: 2, what, remedy })
        }
        _ => Ok(()),
    }
}

fn seconds(read: &recording::Recording, time: &Time, counts: bool) -> Vec<f64> {
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
    read.numbers.get(column).into_iter().flatten().map(to_seconds).collect() // instants are in seconds already
}

/// Indices of the samples whose time is later than all before.
fn increasing(time: &[f64]) -> Vec<usize> {
    let mut latest = f64::NEG_INFINITY;
    (0..time.len())
        .filter(|i| {
            let later = time[*i] > latest;
            latest = latest.max(time[*i]);
            later
        })
        .collect()
}

fn disordered(path: &Path, source: &Source, time: &[f64], first_row: usize) -> DataError {
    let mut wrong = (1..time.len()).filter(|i| !(time[*i] > time[*i - 1]));
    let first = wrong.next().unwrap_or(1);
    let mut more = More::default();
    wrong.for_each(|i| more.add(first_row + i));
    let (path, of, row) = (path.to_path_buf(), source.name.clone(), first_row + first);
    DataError::SourceTime { path, of, row, before: time[first - 1], after: time[first], more }
}

/// Columns that the file does not have.
fn missing<'a>(path: &Path, columns: &BTreeSet<String>, known: impl Iterator<Item = &'a str>) -> Result<(), DataError> {
    let known: Vec<&str> = known.collect();
    let problem = |column: &String| {
        let meant = crate::text::spelling::meant(column, known.iter().copied());
        let meant = meant.map_or(String::new(), |name| format!(" (did you mean `{name}`?)"));
        let first: Vec<String> = known.iter().take(40).map(|name| format!("`{name}`")).collect();
        let more = if known.len() > 40 { format!(" and {} more", known.len() - 40) } else { String::new() };
        let known = first.join(" ") + &more + &meant;
        DataError::MissingColumn { path: path.to_path_buf(), column: column.clone(), known }
    };
    let lacking = columns.iter().filter(|column| !known.contains(&column.as_str())).map(problem);
    Problems(lacking.collect()).into_result()
}
