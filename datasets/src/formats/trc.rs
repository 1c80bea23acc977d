//! TRC: positions of markers, separated by tabs or commas.
//!
//! ```text
//! PathFileType  4  (X/Y/Z)  file.trc
//! DataRate  CameraRate  NumFrames  NumMarkers  Units  OrigDataRate  OrigDataStartFrame  OrigNumFrames
//! 100       100         652        51          mm     …
//! Frame#  Time  Marker1      Marker2
//!               X1  Y1  Z1   X2  Y2  Z2
//!
//! 1       0.00  733.7  …
//! ```
//!
//! A marker's name stands over the first of its three columns. Times are frame ÷ rate where that agrees with `Time`.
//!
//! Source: opensimconfluence.atlassian.net, "Marker (.trc) Files".

use std::path::Path;

use super::numbers::{self, Layout, next_names, without_empty_end};
use super::{Column, Format, Group, Keep, Take, no_such, unique};
use crate::error::DataError;
use crate::ingest::recording::csv::rows::{BLANKS, Rows};
use crate::ingest::recording::csv::text;

pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let mut take = Take::new(Format::Trc);
    let text = text::read(path, &mut take.notes)?;
    let separator = numbers::separator(&text);
    let mut rows = Rows::new(path, &text, separator, 1);
    let (keys, values) = head(path, &mut rows)?;
    let value = |key: &str| values.get(keys.iter().position(|k| k.eq_ignore_ascii_case(key))?).map(String::as_str);
    let names = next_names(&mut rows)?.unwrap_or_default();
    if names.len() < 3 || !names[0].starts_with("Frame") {
        let what = "the fourth row does not begin with Frame#, Time and the markers";
        return Err(no_such(path, rows.number, what, "export the markers as TRC again"));
    }
    let axes = next_names(&mut rows)?.unwrap_or_default();
    let (names, axes) = if separator == BLANKS { spread(&names, &axes) } else { (names, axes) };
    let unit = match value("Units") {
        Some("mm") => Some("mm"),
        Some("m") => Some("m"),
        Some("cm") => Some("cm"),
        _ => None,
    };
    let mut columns = columns(&names, &axes, unit);
    unique(&mut columns);
    let rows = numbers::read(path, &mut rows, Layout { separator, lead: 2, columns, until_blank: false }, keep)?;
    if rows.frames.is_empty() {
        return Err(DataError::NoRows { path: path.to_path_buf() });
    }
    take.lost = rows.lost;
    take.notes.extend(rows.notes);
    if unit.is_none() {
        take.notes.push(format!("unit {:?} is not known: its columns have none", value("Units").unwrap_or("")));
    }
    let rate = value("DataRate").and_then(|rate| rate.replace(',', ".").parse::<f64>().ok()).filter(|rate| *rate > 0.0);
    let from_frames = numbers::from_frames(&rows.frames, &rows.seconds, rate.as_slice());
    let (time, rate) = match from_frames {
        Some((time, rate)) => {
            take.notes.push(format!("time is frame ÷ {rate} Hz, which agrees with the column of times"));
            (time, Some(rate))
        }
        None => {
            if let Some(at) = rows.seconds.iter().position(|t| !t.is_finite()) {
                return Err(no_such(path, rows.first_row + at, "the time is empty", "write the time, or a DataRate"));
            }
            take.notes.push("the column of times does not follow frame ÷ DataRate and is taken as it is".into());
            (rows.seconds, None)
        }
    };
    promised(&mut take, value("NumFrames"), time.len(), "frames");
    promised(&mut take, value("NumMarkers"), rows.columns.len() / 3, "markers");
    let (samples, span) = (time.len(), (time[0], time[time.len() - 1]));
    let kept = rows.columns.iter().any(|column| !column.values.is_empty());
    let time = if kept { time } else { Vec::new() };
    take.groups.push(Group {
        name: String::new(),
        samples,
        span,
        rate,
        time,
        columns: rows.columns,
        first_row: rows.first_row,
    });
    Ok(take)
}

/// Keys and their values, from the first three rows.
fn head(path: &Path, rows: &mut Rows) -> Result<(Vec<String>, Vec<String>), DataError> {
    let first = next_names(rows)?.unwrap_or_default();
    if !first.first().is_some_and(|cell| cell.starts_with("PathFileType")) {
        let what = "the first row does not begin with PathFileType, as one of a TRC file does";
        return Err(no_such(path, 1, what, "export the markers as TRC again, or name another `format`"));
    }
    Ok((next_names(rows)?.unwrap_or_default(), next_names(rows)?.unwrap_or_default()))
}

/// Names and axes as they stand where empty cells can be written: two cells before the axes, and a name over its first axis.
fn spread(names: &[String], axes: &[String]) -> (Vec<String>, Vec<String>) {
    let each = axes.len() / names.len().saturating_sub(2).max(1);
    let name =
        |name: &String| std::iter::once(name.clone()).chain(std::iter::repeat_n(String::new(), each.saturating_sub(1)));
    let lead = names.iter().take(2).cloned();
    let none = std::iter::repeat_n(String::new(), 2);
    (lead.chain(names.iter().skip(2).flat_map(name)).collect(), none.chain(axes.iter().cloned()).collect())
}

fn promised(take: &mut Take, value: Option<&str>, found: usize, what: &str) {
    let count = value.and_then(|value| value.parse::<usize>().ok());
    if let Some(count) = count.filter(|count| *count != found) {
        take.lost.push(format!("the header promises {count} {what}, and the file has {found}"));
    }
}

fn columns(names: &[String], axes: &[String], unit: Option<&'static str>) -> Vec<Column> {
    let axes = without_empty_end(axes.to_vec());
    let width = axes.len().max(without_empty_end(names.to_vec()).len());
    let mut marker = String::new();
    (2..width)
        .map(|at| {
            if let Some(name) = names.get(at).filter(|name| !name.is_empty()) {
                marker = name.replace(':', ".");
            }
            let axis = axes.get(at).map_or("", String::as_str).trim_end_matches(|c: char| c.is_ascii_digit());
            Column { name: format!("{marker}.{axis}"), unit, values: Vec::new() }
        })
        .collect()
}
