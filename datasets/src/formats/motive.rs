//! CSV of OptiTrack Motive, versions 1.1 to 1.25.
//!
//! ```text
//! Format Version,1.23,Take Name,…,Capture Frame Rate,120,Export Frame Rate,120,Rotation Type,Quaternion,Length Units,Meters,…
//!
//! ,Type,Rigid Body,Rigid Body,…,Rigid Body Marker,…,Marker,…
//! ,Name,Body,Body,…,Body:Marker1,…,Body:Marker1,…
//! ,ID,"…",…
//! ,,Rotation,Rotation,…,Position,…,Mean Marker Error
//! Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,…
//! ```
//!
//! The row that begins with `Frame` is found, and the rows above it are recognized by their text: in 1.21 the labels in their
//! second cells are blank, 1.25 has a row `Parent` more, 1.24 may have a column `TimeCode`, and the first row may be absent.
//! Times are frame ÷ rate where that agrees with the column of times, which is rounded to milliseconds in some versions.
//! `Rigid Body Marker` is where the solved body has its marker: such columns have `solved` in their names; `Marker` is
//! measured.
//!
//! Source: docs.optitrack.com, "Data Export: CSV".

use std::path::Path;

use super::numbers::{self, Layout, next_names};
use super::{Column, Format, Group, Keep, Take, no_such, unique};
use crate::error::DataError;
use crate::ingest::recording::csv::rows::Rows;
use crate::ingest::recording::csv::text;

/// Rows above the row of `Frame`, at most.
const HEADER_ROWS: usize = 40;

/// Kinds of things in the row `Type`.
const TYPES: &[&str] = &["Rigid Body", "Rigid Body Marker", "Marker", "Bone", "Bone Marker", "Skeleton"];

/// The header, as far as it says something.
struct Header {
    rows: Vec<Vec<String>>,
    labels: Vec<String>,
}

pub(super) fn read(path: &Path, keep: Keep) -> Result<Take, DataError> {
    let mut take = Take::new(Format::Motive);
    let text = text::read(path, &mut take.notes)?;
    let separator = numbers::separator(&text);
    let mut rows = Rows::new(path, &text, separator, 1);
    let header = Header::read(path, &mut rows)?;
    let lead = if header.labels.get(2).is_some_and(|label| label.eq_ignore_ascii_case("timecode")) { 3 } else { 2 };
    let mut columns = header.columns(lead);
    unique(&mut columns);
    let rows = numbers::read(path, &mut rows, Layout { separator, lead, columns, until_blank: false }, keep)?;
    if rows.frames.is_empty() {
        return Err(DataError::NoRows { path: path.to_path_buf() });
    }
    take.lost = rows.lost;
    take.notes.extend(rows.notes);
    let (time, rate) = header.times(&rows.frames, &rows.seconds, &mut take.notes, path, rows.first_row)?;
    header.describe(&mut take, rows.frames.len());
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

impl Header {
    fn read(path: &Path, rows: &mut Rows) -> Result<Header, DataError> {
        let mut above = Vec::new();
        while let Some(names) = next_names(rows)? {
            if names[0] == "Frame" {
                return Ok(Header { rows: above, labels: names });
            }
            above.push(names);
            if above.len() > HEADER_ROWS {
                break;
            }
        }
        let what = "no row begins with `Frame`, as one of a Motive export does";
        Err(no_such(path, rows.number, what, "export the take as CSV again, or name another `format`"))
    }

    /// The value of a key in the first row.
    fn value(&self, key: &str) -> Option<&str> {
        let first = self.rows.first()?;
        let at = first.iter().step_by(2).position(|cell| cell.eq_ignore_ascii_case(key))?;
        first.get(2 * at + 1).map(String::as_str)
    }

    /// Unit of positions.
    fn length_unit(&self) -> Option<&'static str> {
        match self.value("Length Units")?.to_lowercase().as_str() {
            "meters" | "metres" => Some("m"),
            "centimeters" | "centimetres" => Some("cm"),
            "millimeters" | "millimetres" => Some("mm"),
            _ => None,
        }
    }

    /// Unit of rotations: components of a quaternion have none.
    fn rotation_unit(&self) -> Option<&'static str> {
        match self.value("Rotation Type") {
            Some(kind) if kind.eq_ignore_ascii_case("quaternion") => Some("1"),
            Some(_) => Some("deg"),
            None => None,
        }
    }

    /// The row of which most cells behind the second satisfy `fits`.
    fn row(&self, fits: impl Fn(&str) -> bool) -> Option<&Vec<String>> {
        let count = |row: &&Vec<String>| row.iter().skip(2).filter(|cell| fits(cell)).count();
        self.rows.iter().rev().filter(|row| 2 * count(row) > row.len().saturating_sub(2).max(1)).max_by_key(count)
    }

    /// The row that is named in its second cell, or the one `below` that of types.
    fn named(&self, label: &str, below: usize) -> Option<&Vec<String>> {
        let labelled = self.rows.iter().find(|row| row.get(1).is_some_and(|cell| cell == label));
        let types = self.rows.iter().position(|row| row.iter().skip(2).any(|cell| TYPES.contains(&cell.as_str())));
        labelled.or_else(|| self.rows.get(types? + below))
    }

    fn columns(&self, lead: usize) -> Vec<Column> {
        let blank = Vec::new();
        let types = self.named("Type", 0).unwrap_or(&blank);
        let names = self.named("Name", 1).unwrap_or(&blank);
        let quantity = |cell: &str| ["Rotation", "Position"].contains(&cell);
        let quantities = self.row(quantity).unwrap_or(&blank);
        let cell = |row: &[String], at: usize| row.get(at).cloned().unwrap_or_default();
        let width = self.labels.len().max(names.len()).max(lead);
        let column =
            |at: usize| self.column(&cell(types, at), &cell(names, at), &cell(quantities, at), &cell(&self.labels, at));
        (lead..width).map(column).collect()
    }

    /// `Body.Marker1.X`, `Body.Position.X`, `Body.Marker1.solved.X`.
    fn column(&self, kind: &str, name: &str, quantity: &str, axis: &str) -> Column {
        let marker = kind.ends_with("Marker") || kind.is_empty();
        let place = name.replace(':', ".");
        let solved = if kind == "Rigid Body Marker" { ".solved" } else { "" };
        let end = match (quantity, axis) {
            ("Position", axis) if marker && !axis.is_empty() => format!(".{axis}"),
            (quantity, "") => format!(".{quantity}"),
            ("", axis) => format!(".{axis}"),
            (quantity, axis) => format!(".{quantity}.{axis}"),
        };
        let unit = match quantity {
            "Position" => self.length_unit(),
            "Rotation" => self.rotation_unit(),
            error if error.ends_with("Error") || error == "Error Per Marker" => self.length_unit(),
            _ => Some("1"),
        };
        Column { name: format!("{place}{solved}{end}"), unit, values: Vec::new() }
    }

    /// Times, and the rate that they follow.
    fn times(
        &self,
        frames: &[f64],
        stamps: &[f64],
        notes: &mut Vec<String>,
        path: &Path,
        first_row: usize,
    ) -> Result<(Vec<f64>, Option<f64>), DataError> {
        let rate = |key: &str| {
            self.value(key)?.replace(',', ".").parse::<f64>().ok().filter(|rate| rate.is_finite() && *rate > 0.0)
        };
        let declared: Vec<f64> =
            ["Export Frame Rate", "Capture Frame Rate"].iter().filter_map(|key| rate(key)).collect();
        if let Some((time, rate)) = numbers::from_frames(frames, stamps, &declared) {
            notes.push(format!("time is frame ÷ {rate} Hz, which agrees with the column of times"));
            return Ok((time, Some(rate)));
        }
        if let Some(at) = (0..frames.len()).find(|i| !stamps[*i].is_finite()) {
            let row = first_row + at;
            return Err(no_such(path, row, "the time is empty", "export the take again with its times and frame rate"));
        }
        notes.push(match declared.first() {
            Some(rate) => format!("the column of times does not follow frame ÷ {rate} Hz and is taken as it is"),
            None => "no frame rate is declared: the column of times is taken as it is".into(),
        });
        Ok((stamps.to_vec(), None))
    }

    fn describe(&self, take: &mut Take, samples: usize) {
        for key in ["Format Version", "Rotation Type", "Coordinate Space", "Capture Start Time"] {
            take.notes.extend(self.value(key).map(|value| format!("{key}: {value}")));
        }
        take.notes.extend(self.length_unit().map(|unit| format!("Length Units: {unit}")));
        if self.length_unit().is_none() {
            take.notes.push(match self.value("Length Units") {
                Some(unit) => format!("Length Units: {unit} is not known, so positions have no unit"),
                None => "no unit of length is declared".into(),
            });
        }
        let promised = self.value("Total Exported Frames").and_then(|value| value.parse::<usize>().ok());
        if let Some(promised) = promised.filter(|promised| *promised != samples) {
            take.lost.push(format!("the header promises {promised} frames, and the file has {samples}"));
        }
    }
}
