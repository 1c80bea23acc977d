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

use super::lines::Lines;
use super::numbers::{self, Layout, Rows};
use super::{Column, Format, Group, Keep, Take, no_such};
use crate::error::DataError;
use crate::units::Unit;

/// Rows before the first section, at most.
const BEFORE: usize = 40;

pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let mut lines = Lines::open(path)?;
    let mut take = Take::new(Format::Vicon);
    while let Some(name) = section_name(&mut lines, take.groups.is_empty())? {
        let group = section(&mut lines, &name, keep, &mut take)?;
        take.groups.push(group);
    }
    match take.groups.is_empty() {
        true => Err(no_such(path, lines.row, "there is no section of a Vicon export", "name another `format`")),
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
fn section_name(lines: &mut Lines, first: bool) -> Result<Option<String>, DataError> {
    while let Some(names) = lines.names(b',')? {
        if !names[0].is_empty() {
            return Ok(Some(names[0].clone()));
        }
        if first && lines.row > BEFORE {
            break;
        }
    }
    Ok(None)
}

fn section(lines: &mut Lines, name: &str, keep: Keep, take: &mut Take) -> Result<Group, DataError> {
    let path = lines.path.clone();
    let wrong =
        |row, what: &str| no_such(&path, row, format!("section `{name}`: {what}"), "export the trial as CSV again");
    let cut = |lines: &Lines| wrong(lines.row, "the file ends in its header");
    let rate = lines.names(b',')?.ok_or_else(|| cut(lines))?;
    let rate = rate[0].parse::<f64>().ok().filter(|rate| rate.is_finite() && *rate > 0.0);
    let rate = rate.ok_or_else(|| wrong(lines.row, "its second row is no rate in Hz"))?;
    let markers = lines.names(b',')?.ok_or_else(|| cut(lines))?;
    let axes = lines.names(b',')?.ok_or_else(|| cut(lines))?;
    if axes.len() < 3 || axes[0] != "Frame" || axes[1] != "Sub Frame" {
        return Err(wrong(lines.row, "its fourth row does not begin with Frame,Sub Frame"));
    }
    let units = lines.names(b',')?.ok_or_else(|| cut(lines))?;
    let columns = columns(&markers, &axes, &units, &mut take.notes);
    let layout = Layout { separator: b',', lead: 2, columns, until_blank: true };
    let rows = numbers::read(lines, layout, keep)?;
    if rows.frames.is_empty() {
        return Err(DataError::NoRows { path });
    }
    take.notes.push(format!("section `{name}`: time is frame ÷ {rate} Hz, from frame 1"));
    take.lost.extend(rows.lost.iter().cloned());
    Ok(group(name, rate, rows))
}

fn group(name: &str, rate: f64, rows: Rows) -> Group {
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
    for at in 2..super::lines::without_empty_end(axes.to_vec()).len() {
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
