//! Splitting of a recording into trials: rows are grouped by name, time is checked, lost markers are skipped, units become SI.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::DMatrix;

use crate::error::DataError;
use crate::ingest::layout::{Layout, Naming, Source};
use crate::ingest::periodic::{align_signs, unwrap};
use crate::ingest::recording::Recording;
use crate::ingest::stamps::Stamps;
use crate::join::{Onto, Series, resample};
use crate::manifest::Role;
use crate::trial::{DropReason, Trial};

/// A trial, and the row of the file that each of its samples comes from.
pub(crate) struct Whole {
    pub trial: Trial,
    pub rows: Vec<usize>,
}

/// Rows of each trial, in the order of their first rows; none where the trials have no names.
pub(crate) fn groups(
    recording: &Recording,
    layout: &Layout,
    problems: &mut Vec<DataError>,
) -> Option<Vec<(String, Vec<usize>)>> {
    let stem = recording.path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let all = || (0..recording.rows).collect::<Vec<_>>();
    match (&layout.name, &recording.labels) {
        (Naming::Column(_), Some(labels)) => {
            let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
            let mut places: BTreeMap<&str, usize> = BTreeMap::new();
            for (row, label) in labels.iter().enumerate() {
                let place = *places.entry(label).or_insert(groups.len());
                if place == groups.len() {
                    groups.push((label.clone(), Vec::new()));
                }
                groups[place].1.push(row);
            }
            Some(groups)
        }
        (Naming::Column(_), None) => None,
        (Naming::File(pattern), _) => match pattern.captures(&stem).and_then(|c| c.get(1)) {
            Some(name) => Some(vec![(name.as_str().to_string(), all())]),
            None => {
                let (path, pattern) = (recording.path.clone(), pattern.to_string());
                problems.push(DataError::UnnamedTrial { path, pattern });
                None
            }
        },
        _ => Some(vec![(stem, all())]),
    }
}

/// One trial, if nothing is wrong with it; its role is set later.
pub(crate) fn trial(
    recording: &Recording,
    file: &Path,
    name: String,
    rows: &[usize],
    layout: &Layout,
    problems: &mut Vec<DataError>,
) -> Option<Whole> {
    let before = problems.len();
    let recording = &corrected(recording, rows, layout);
    let time = seconds(recording, rows, layout);
    check_time(recording, rows, &time, layout, problems);
    if recording.spoiled || problems.len() > before {
        return None;
    }
    let Present { kept, mut unmeasured, dropped } = present(recording, rows, layout);
    let last = kept.last().copied().unwrap_or(0); // nothing follows it that could remember
    unmeasured.retain(|i| *i < last);
    let of = |kept: &[usize], measured: &[Source]| {
        let rows: Vec<usize> = kept.iter().map(|i| rows[*i]).collect();
        let read = |sources: &[Source]| matrix(recording, &rows, sources);
        let optional = |sources: &[Source]| (!sources.is_empty()).then(|| read(sources));
        Trial {
            name: name.clone(),
            role: Role::Excluded,
            time: kept.iter().map(|i| time[*i]).collect(),
            actuators: read(&layout.actuators),
            context: read(&layout.context),
            measured: read(measured),
            predicted: optional(&layout.predicted),
            vehicle: optional(&layout.vehicle),
            conditions: BTreeMap::new(),
            dropped: BTreeMap::new(),
            file: file.to_path_buf(),
            unmeasured: None,
        }
    };
    let trial = Trial { dropped, unmeasured: Trial::some(of(&unmeasured, &[])), ..of(&kept, &layout.measured) };
    Some(Whole { trial, rows: kept.iter().map(|i| recording.row(rows[*i])).collect() })
}

/// The recording with angles and counters of these rows unwrapped, the signs of quaternions kept, and inputs filled.
fn corrected<'r>(recording: &'r Recording, rows: &[usize], layout: &Layout) -> Cow<'r, Recording> {
    if layout.periods.is_empty() && layout.quaternions.is_empty() && layout.fill.is_empty() {
        return Cow::Borrowed(recording);
    }
    let mut own = recording.clone();
    let of_rows = |own: &Recording, column: &String| {
        own.numbers.get(column).map(|cells| rows.iter().map(|row| cells[*row]).collect::<Vec<f64>>())
    };
    let write = |own: &mut Recording, column: &String, values: &[f64]| {
        let Some(cells) = own.numbers.get_mut(column) else { return };
        rows.iter().zip(values).for_each(|(row, value)| cells[*row] = *value);
    };
    for (column, period) in &layout.periods {
        let Some(mut values) = of_rows(&own, column) else { continue };
        unwrap(&mut values, *period);
        write(&mut own, column, &values);
    }
    for four in &layout.quaternions {
        let mut values = four.each_ref().map(|column| of_rows(&own, column).unwrap_or_default());
        align_signs(&mut values);
        four.iter().zip(&values).for_each(|(column, values)| write(&mut own, column, values));
    }
    let time = seconds(&own, rows, layout);
    for (column, rule) in &layout.fill {
        let Some(values) = of_rows(&own, column) else { continue };
        let onto = Onto { times: &time, step: 0.0, gap: f64::INFINITY, rule: *rule };
        write(&mut own, column, &resample(&Series::new(&time, &values), &onto));
    }
    Cow::Owned(own)
}

/// Time of the samples, s; NaN where it cannot be read.
fn seconds(recording: &Recording, rows: &[usize], layout: &Layout) -> Vec<f64> {
    if let Some(ticks) = &recording.ticks {
        return ticks.seconds(rows);
    }
    let cells = layout.time.source().map(|source| recording.numbers.get(&source.column));
    let cell = |row: usize| cells.map_or(0.0, |cells| cells.map_or(f64::NAN, |cells| cells[row]));
    rows.iter().enumerate().map(|(i, row)| layout.time.seconds(i, cell(*row))).collect()
}

fn matrix(recording: &Recording, rows: &[usize], sources: &[Source]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(rows.len(), sources.len());
    for (source, mut column) in sources.iter().zip(matrix.column_iter_mut()) {
        let Some(cells) = recording.numbers.get(&source.column) else { continue };
        for (value, row) in column.iter_mut().zip(rows) {
            *value = source.unit.to_si(cells[*row]);
        }
    }
    matrix
}

/// Samples by the cells that they have.
#[derive(Default)]
struct Present {
    /// Those with all cells.
    kept: Vec<usize>,
    /// Those that lack nothing but an output.
    unmeasured: Vec<usize>,
    /// Number of those that lack a cell, by reason.
    dropped: BTreeMap<DropReason, usize>,
}

fn present(recording: &Recording, rows: &[usize], layout: &Layout) -> Present {
    let columns = |sources: &[Source]| -> Vec<&Vec<f64>> {
        sources.iter().filter_map(|s| recording.numbers.get(&s.column)).collect()
    };
    let (measured, vehicle) = (columns(&layout.measured), columns(&layout.vehicle));
    let inputs = match layout.joined || !layout.fill.is_empty() {
        true => [columns(&layout.actuators), columns(&layout.context), columns(&layout.predicted)].concat(),
        false => Vec::new(),
    };
    let lost = |columns: &[&Vec<f64>], row: usize| columns.iter().any(|c| c[row].is_nan());
    let mut found = Present::default();
    for (i, row) in rows.iter().enumerate() {
        let reason = match () {
            () if lost(&inputs, *row) => DropReason::MissingSource,
            // its acceleration is an input of effects
            () if lost(&vehicle, *row) => DropReason::MissingVehicle,
            () if lost(&measured, *row) => DropReason::MissingMarker,
            () => {
                found.kept.push(i);
                continue;
            }
        };
        *found.dropped.entry(reason).or_insert(0) += 1;
        if reason == DropReason::MissingMarker {
            found.unmeasured.push(i);
        }
    }
    found
}

/// Checks that time increases from row to row.
fn check_time(recording: &Recording, rows: &[usize], time: &[f64], layout: &Layout, problems: &mut Vec<DataError>) {
    let Some(source) = layout.time.source() else { return };
    let raw = recording.numbers.get(&source.column).filter(|_| recording.ticks.is_none());
    let stamps = Stamps {
        path: &recording.path,
        column: &source.column,
        time,
        raw: raw.map(Vec::as_slice),
        ticks: recording.ticks.as_ref(),
        row: &|i| recording.row(rows[i]),
        index: &|i| rows[i],
        repeats: &|first, second| repeats(recording, rows[first], rows[second], layout),
    };
    problems.extend(stamps.check());
}

fn repeats(recording: &Recording, first: usize, second: usize, layout: &Layout) -> bool {
    let mut columns = layout.signals().filter_map(|s| recording.numbers.get(&s.column));
    columns.all(|c| c[first].to_bits() == c[second].to_bits())
}
