//! A recording becomes trials: rows are grouped by name, time is checked, lost markers are skipped, numbers become SI.

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::DMatrix;

use crate::error::DataError;
use crate::layout::{Layout, Naming, Source};
use crate::manifest::Role;
use crate::recording::Recording;
use crate::trial::{DropReason, Trial};

/// How many steps back in time are listed for one trial.
const LISTED: usize = 10;

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

/// One trial; its role is set later.
pub(crate) fn trial(
    recording: &Recording,
    file: &Path,
    name: String,
    rows: &[usize],
    layout: &Layout,
    problems: &mut Vec<DataError>,
) -> Option<Trial> {
    let cells = layout.time.source().and_then(|s| recording.numbers.get(&s.column));
    let stamp = |(i, row): (usize, &usize)| layout.time.seconds(i, cells.map_or(0.0, |c| c[*row]));
    let time: Vec<f64> = rows.iter().enumerate().map(stamp).collect();
    let before = problems.len();
    check_time(recording, rows, &time, layout, problems);
    if problems.len() > before {
        return None;
    }
    let (kept, dropped) = present(recording, rows, layout);
    let rows: Vec<usize> = kept.iter().map(|i| rows[*i]).collect();
    let read = |sources: &[Source]| matrix(recording, &rows, sources);
    let optional = |sources: &[Source]| (!sources.is_empty()).then(|| read(sources));
    Some(Trial {
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
    })
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
    let lost = |columns: &[&Vec<f64>], row: usize| columns.iter().any(|c| c[row].is_nan());
    let (mut kept, mut dropped) = (Vec::with_capacity(rows.len()), BTreeMap::new());
    for (i, row) in rows.iter().enumerate() {
        if lost(&measured, *row) {
            *dropped.entry(DropReason::MissingMarker).or_insert(0) += 1;
        } else if lost(&vehicle, *row) {
            *dropped.entry(DropReason::MissingVehicle).or_insert(0) += 1;
        } else {
            kept.push(i);
        }
    }
    (kept, dropped)
}

/// Time increases from row to row.
fn check_time(recording: &Recording, rows: &[usize], time: &[f64], layout: &Layout, problems: &mut Vec<DataError>) {
    let Some(source) = layout.time.source() else { return };
    let (mut listed, mut more) = (0, 0);
    for i in 1..rows.len() {
        if time[i] > time[i - 1] {
            continue;
        }
        if listed == LISTED {
            more += 1;
            continue;
        }
        listed += 1;
        let (path, column) = (recording.path.clone(), source.column.clone());
        let row = recording.row(rows[i]);
        problems.push(if time[i] < time[i - 1] {
            DataError::TimeReversed { path, row, column, before: time[i - 1], after: time[i] }
        } else if repeats(recording, rows[i - 1], rows[i], layout) {
            DataError::DuplicateRow { path, row, column, first: recording.row(rows[i - 1]), at: time[i] }
        } else {
            DataError::TimeStill { path, row, column, at: time[i] }
        });
    }
    if more > 0 {
        problems.push(DataError::AndMore { path: recording.path.clone(), column: source.column.clone(), count: more });
    }
}

fn repeats(recording: &Recording, first: usize, second: usize, layout: &Layout) -> bool {
    let mut columns = layout.signals().filter_map(|s| recording.numbers.get(&s.column));
    columns.all(|c| c[first].to_bits() == c[second].to_bits())
}
