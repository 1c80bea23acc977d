//! CSV of Vicon Nexus: sections of devices, model outputs and trajectories.
//!
//! ```text
//! Trajectories
//! 100
//! ,,Subject:Marker,,,Subject:Other,,
//! Frame,Sub Frame,X,Y,Z,X,Y,Z
//! ,,mm,mm,mm,mm,mm,mm
//! 1,0,44.1,…
//! ```
//!
//! There is no column of times. Frames count those of the cameras in every section; a section that is sampled more often has
//! sub-frames:
//!
//! ```text
//! t = ((frame − 1)·S + sub-frame)/rate,   S = greatest sub-frame + 1
//! ```
//!
//! Source: docs.vicon.com, "Nexus: ASCII file export".

use std::path::Path;

use super::numbers::{self, Layout, Table, next_names, without_empty_end};
use super::{Column, Format, Group, Keep, Take, no_such};
use crate::error::DataError;
use crate::ingest::recording::csv::rows::{Rows, width};
use crate::ingest::recording::csv::text;
use crate::units::Unit;

/// Rows before the first section, at most.
const BEFORE: usize = 40;

pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let mut take = Take::new(Format::Vicon);
    let text = text::read(path, &mut take.notes)?;
    let separator = numbers::separator(&text);
    let mut rows = Rows::new(path, &text, separator, 1);
    while let Some(name) = section_name(&mut rows, take.groups.is_empty())? {
        let group = section(path, &mut rows, (separator, &name), keep, &mut take)?;
        take.groups.extend(group);
    }
    match take.groups.is_empty() {
        true => Err(no_such(path, rows.number, "there is no section of a Vicon export", "name another `format`")),
        false => {
            one_name_each(&mut take.groups);
            Ok(take)
        }
    }
}

/// Columns of several sections may share names; they then carry that of their section.
fn one_name_each(groups: &mut [Group]) {
    let all: Vec<String> = groups.iter().flat_map(|g| g.columns.iter().map(|c| c.name.clone())).collect();
    for group in groups {
        for column in &mut group.columns {
            if all.iter().filter(|name| **name == column.name).count() > 1 {
                column.name = format!("{}.{}", group.name, column.name);
            }
        }
        super::unique(&mut group.columns);
    }
}

/// The next row that is not blank: the name of a section.
fn section_name(rows: &mut Rows, first: bool) -> Result<Option<String>, DataError> {
    while let Some(names) = next_names(rows)? {
        if !names[0].is_empty() {
            return Ok(Some(names[0].clone()));
        }
        if first && rows.number > BEFORE {
            break;
        }
    }
    Ok(None)
}

/// A section of frames; none for one of another kind, such as events.
fn section(
    path: &Path,
    rows: &mut Rows,
    (separator, name): (char, &str),
    keep: Keep,
    take: &mut Take,
) -> Result<Option<Group>, DataError> {
    let wrong =
        |row, what: &str| no_such(path, row, format!("section `{name}`: {what}"), "export the trial as CSV again");
    let next = |rows: &mut Rows| {
        let names = next_names(rows)?;
        names.ok_or_else(|| wrong(rows.number, "the file ends in its header"))
    };
    let rate = next(rows)?[0].replace(',', ".").parse::<f64>().ok().filter(|rate| rate.is_finite() && *rate > 0.0);
    let rate = rate.ok_or_else(|| wrong(rows.number, "its second row is no rate in Hz"))?;
    let markers = next(rows)?;
    if !markers[0].is_empty() && markers[0] != "Frame" {
        take.notes.push(format!("section `{name}` is skipped: it has no frames"));
        skip(rows)?;
        return Ok(None);
    }
    let axes = next(rows)?;
    if axes.len() < 3 || axes[0] != "Frame" || axes[1] != "Sub Frame" {
        return Err(wrong(rows.number, "its fourth row does not begin with Frame,Sub Frame"));
    }
    let units = next(rows)?;
    let columns = columns(&markers, &axes, &units, &mut take.notes);
    let read = numbers::read(path, rows, Layout { separator, lead: 2, columns, until_blank: true }, keep)?;
    if read.frames.is_empty() {
        return Err(DataError::NoRows { path: path.to_path_buf() });
    }
    take.notes.push(format!("section `{name}`: time is frame ÷ {rate} Hz, from frame 1"));
    take.notes.extend(read.notes.iter().cloned());
    take.lost.extend(read.lost.iter().cloned());
    Ok(Some(group(name, rate, read)))
}

/// Skips the rows up to the next empty line.
fn skip(rows: &mut Rows) -> Result<(), DataError> {
    while rows.next()? {
        let filled = width(&rows.record);
        if rows.blank > 0 || filled == 0 {
            rows.held = filled > 0;
            break;
        }
    }
    Ok(())
}

fn group(name: &str, rate: f64, rows: Table) -> Group {
    let samples_a_frame = 1.0 + rows.seconds.iter().copied().fold(0.0, f64::max);
    let sub = |i: usize| if rows.seconds[i].is_nan() { 0.0 } else { rows.seconds[i] };
    let time: Vec<f64> =
        (0..rows.frames.len()).map(|i| ((rows.frames[i] - 1.0) * samples_a_frame + sub(i)) / rate).collect();
    let (samples, span) = (time.len(), (time[0], time[time.len() - 1]));
    let kept = rows.columns.iter().any(|column| !column.values.is_empty());
    let time = if kept { time } else { Vec::new() };
    let (name, first_row) = (name.to_string(), rows.first_row);
    Group { name, samples, span, rate: Some(rate), time, columns: rows.columns, first_row }
}

/// A marker's name stands over the first of its columns. Columns without a name and an axis, at the end, are none.
fn columns(markers: &[String], axes: &[String], units: &[String], notes: &mut Vec<String>) -> Vec<Column> {
    let (mut columns, mut marker) = (Vec::new(), String::new());
    let mut strange = std::collections::BTreeSet::new();
    for at in 2..without_empty_end(axes.to_vec()).len() {
        if let Some(name) = markers.get(at).filter(|name| !name.is_empty()) {
            marker = name.replace(':', ".");
        }
        let written = units.get(at).map_or("", String::as_str);
        let unit = unit(written);
        if unit.is_none() && !written.is_empty() {
            strange.insert(written.to_string());
        }
        columns.push(Column { name: format!("{marker}.{}", axes[at]), unit, values: Vec::new() });
    }
    notes.extend(strange.iter().map(|unit| format!("unit {unit:?} is not known: its columns have none")));
    columns
}

/// A unit as Nexus writes it.
fn unit(written: &str) -> Option<&'static str> {
    let name = match written {
        "N.mm" | "Nmm" => "N*mm",
        "N.m" | "Nm" => "N*m",
        "m/s²" | "m/s/s" => "m/s^2",
        "degs" | "degrees" => "deg",
        other => other,
    };
    Unit::parse(name).ok().map(|unit| unit.name)
}
