//! Splitting of a recording into trials: rows are grouped by name, time is checked, lost markers are skipped, units become SI.

use std::collections::BTreeMap;
use std::mem::discriminant;
use std::path::Path;

use nalgebra::DMatrix;

use crate::error::{DataError, More};
use crate::ingest::layout::{Layout, Naming, Source};
use crate::ingest::recording::Recording;
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
    let time = seconds(recording, rows, layout);
    check_time(recording, rows, &time, layout, problems);
    if recording.spoiled || problems.len() > before {
        return None;
    }
    let (kept, dropped) = present(recording, rows, layout);
    let rows: Vec<usize> = kept.iter().map(|i| rows[*i]).collect();
    let read = |sources: &[Source]| matrix(recording, &rows, sources);
    let optional = |sources: &[Source]| (!sources.is_empty()).then(|| read(sources));
    let trial = Trial {
        name,
        role: Role::Excluded,
        time: kept.iter().map(|i| time[*i]).collect(),
        actuators: read(&layout.actuators),
        context: read(&layout.context),
        measured: read(&layout.measured),
        predicted: optional(&layout.predicted),
        vehicle: optional(&layout.vehicle),
        conditions: BTreeMap::new(),
        dropped,
        file: file.to_path_buf(),
    };
    Some(Whole { trial, rows: rows.iter().map(|row| recording.row(*row)).collect() })
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

/// The samples that have all their cells, and how many have not.
fn present(recording: &Recording, rows: &[usize], layout: &Layout) -> (Vec<usize>, BTreeMap<DropReason, usize>) {
    let columns = |sources: &[Source]| -> Vec<&Vec<f64>> {
        sources.iter().filter_map(|s| recording.numbers.get(&s.column)).collect()
    };
    let (measured, vehicle) = (columns(&layout.measured), columns(&layout.vehicle));
    let inputs = match layout.joined {
        true => [columns(&layout.actuators), columns(&layout.context), columns(&layout.predicted)].concat(),
        false => Vec::new(),
    };
    let lost = |columns: &[&Vec<f64>], row: usize| columns.iter().any(|c| c[row].is_nan());
    let (mut kept, mut dropped) = (Vec::with_capacity(rows.len()), BTreeMap::new());
    for (i, row) in rows.iter().enumerate() {
        if lost(&measured, *row) {
            *dropped.entry(DropReason::MissingMarker).or_insert(0) += 1;
        } else if lost(&vehicle, *row) {
            *dropped.entry(DropReason::MissingVehicle).or_insert(0) += 1;
        } else if lost(&inputs, *row) {
            *dropped.entry(DropReason::MissingSource).or_insert(0) += 1;
        } else {
            kept.push(i);
        }
    }
    (kept, dropped)
}

/// Checks that time increases from row to row. Of each kind of violation the first is reported, with the rows of the others.
fn check_time(recording: &Recording, rows: &[usize], time: &[f64], layout: &Layout, problems: &mut Vec<DataError>) {
    let Some(source) = layout.time.source() else { return };
    let mut found = Vec::<DataError>::new();
    let readable: Vec<usize> = (0..rows.len()).filter(|i| time[*i].is_finite()).collect();
    for pair in readable.windows(2).filter(|pair| time[pair[1]] <= time[pair[0]]) {
        let (before, at) = (time[pair[0]], time[pair[1]]);
        let (path, column, row) = (recording.path.clone(), source.column.clone(), recording.row(rows[pair[1]]));
        let more = More::default();
        let problem = if at < before {
            DataError::TimeReversed { path, row, column, before, after: at, more }
        } else if repeats(recording, rows[pair[0]], rows[pair[1]], layout) {
            DataError::DuplicateRow { path, row, column, first: recording.row(rows[pair[0]]), at, more }
        } else {
            DataError::TimeStill { path, row, column, at, more }
        };
        let alike = |other: &&mut DataError| discriminant(*other) == discriminant(&problem);
        match found.iter_mut().find(alike).and_then(DataError::more) {
            Some(more) => more.add(row),
            None => found.push(problem),
        }
    }
    problems.extend(found);
}

fn repeats(recording: &Recording, first: usize, second: usize, layout: &Layout) -> bool {
    let mut columns = layout.signals().filter_map(|s| recording.numbers.get(&s.column));
    columns.all(|c| c[first].to_bits() == c[second].to_bits())
}
