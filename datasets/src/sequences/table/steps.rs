//! Conversion of the rows of a file to sequences, with checks of each row.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;

use nalgebra::DMatrix;

use super::super::{Asked, Sequence};
use super::{Rules, Table, Tables, window};
use crate::error::{DataError, More};
use crate::preprocessing::segments::median_step;

/// The names that a column of parts may hold.
const PARTS: [&str; 3] = ["training", "validation", "test"];

/// The windows of a sequence, or all of it, and where it came from.
pub struct Cut {
    pub name: String,
    pub sequences: Vec<Sequence>,
    pub path: PathBuf,
    /// Its part by the column, if there is one.
    pub part: Option<usize>,
}

/// The sequences of one file; those with a problem are left out.
pub fn cut(tables: &Tables, rules: Rules, table: &Table, problems: &mut Vec<DataError>) -> Vec<Cut> {
    let mut sequences = vec![];
    for (name, rows) in runs(table, problems) {
        let reader = Reader { tables, table, name: &name, rows };
        let before = problems.len();
        let part = reader.part(problems);
        reader.check(rules, problems);
        if problems.len() == before {
            let (path, windows) = (table.numbers.path.clone(), reader.sequences(rules));
            sequences.push(Cut { name: name.clone(), sequences: windows, path, part });
        }
    }
    sequences
}

/// Runs of rows with the same name; the whole file where there is no column of names.
fn runs(table: &Table, problems: &mut Vec<DataError>) -> Vec<(String, Range<usize>)> {
    let Some(names) = &table.numbers.labels else {
        let name = table.numbers.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        return vec![(name, 0..table.numbers.rows)];
    };
    let mut seen = BTreeSet::new();
    let mut runs = vec![];
    let mut start = 0;
    for run in names.chunk_by(|a, b| a == b) {
        let name = run[0].clone();
        if !seen.insert(name.clone()) {
            let (path, row) = (table.numbers.path.clone(), table.numbers.row(start));
            problems.push(DataError::ScatteredSequence { path, row, name: name.clone() });
        }
        runs.push((name, start..start + run.len()));
        start += run.len();
    }
    runs
}

/// The rows of one sequence.
struct Reader<'a> {
    tables: &'a Tables,
    table: &'a Table,
    name: &'a str,
    rows: Range<usize>,
}

impl Reader<'_> {
    fn column(&self, name: &str) -> &[f64] {
        &self.table.numbers.numbers[name][self.rows.clone()]
    }

    fn path(&self) -> PathBuf {
        self.table.numbers.path.clone()
    }

    /// The number of a row as a spreadsheet shows it.
    fn row(&self, k: usize) -> usize {
        self.table.numbers.row(self.rows.start + k)
    }

    fn part(&self, problems: &mut Vec<DataError>) -> Option<usize> {
        let (labels, column) = (self.table.parts.as_ref()?, self.tables.part.as_ref()?);
        let labels = &labels[self.rows.clone()];
        if let Some(k) = labels.iter().position(|label| *label != labels[0]) {
            let (path, row, column, name) = (self.path(), self.row(k), column.clone(), self.name.to_string());
            let (before, value) = (labels[0].clone(), labels[k].clone());
            problems.push(DataError::TwoParts { path, row, column, name, before, value });
        }
        let found = PARTS.iter().position(|name| *name == labels[0]);
        if found.is_none() {
            let (path, row, column, value) = (self.path(), self.row(0), column.clone(), labels[0].clone());
            problems.push(DataError::NoPart { path, row, column, value });
        }
        found
    }

    fn check(&self, rules: Rules, problems: &mut Vec<DataError>) {
        let (steps, needed) = (self.rows.len(), 1 + self.tables.ahead);
        if steps < needed {
            let (path, row, name) = (self.path(), self.row(0), self.name.to_string());
            problems.push(DataError::ShortSequence { path, row, name, steps, needed });
        }
        problems.extend(self.tables.keep.as_deref().and_then(|column| self.check_keep(column)));
        problems.extend(self.tables.time.as_deref().and_then(|column| self.check_time(column)));
        problems.extend(self.tables.elapsed.as_deref().and_then(|column| self.check_elapsed(column)));
        if rules.labels {
            problems.extend(self.tables.targets.iter().filter_map(|column| self.check_label(column)));
        }
    }

    /// A column of times, in s.
    fn seconds(&self, column: &str) -> Vec<f64> {
        let unit = self.tables.unit_of_time();
        self.column(column).iter().map(|&time| unit.map_or(time, |unit| unit.to_si(time))).collect()
    }

    fn check_time(&self, column: &str) -> Option<DataError> {
        let time = self.seconds(column);
        let k = (1..time.len()).find(|&k| time[k] <= time[k - 1])?;
        let (path, row, column, before, after) = (self.path(), self.row(k), column.to_string(), time[k - 1], time[k]);
        Some(match after < before {
            true => {
                let (more, remedy) = (More::default(), "sort the rows of the sequence by time".into());
                DataError::TimeReversed { path, row, column, before, after, more, remedy }
            }
            false => DataError::TimeStill { path, row, column, at: after, more: More::default() },
        })
    }

    fn check_elapsed(&self, column: &str) -> Option<DataError> {
        let elapsed = self.column(column);
        let k = elapsed.iter().position(|&value| value < 0.0)?;
        let (path, row, column, value) = (self.path(), self.row(k), column.to_string(), elapsed[k]);
        Some(DataError::NegativeElapsed { path, row, column, value })
    }

    /// Checks that the column holds 0 and 1, with at least one 1.
    fn check_keep(&self, column: &str) -> Option<DataError> {
        let keep = self.column(column);
        let (path, name, steps) = (self.path(), self.name.to_string(), 0);
        if let Some(k) = keep.iter().position(|&value| value != 0.0 && value != 1.0) {
            let (column, value) = (column.to_string(), keep[k]);
            return Some(DataError::NoLabel { path, row: self.row(k), column, value });
        }
        let none = self.seen().is_empty();
        none.then(|| DataError::ShortSequence { path, row: self.row(0), name, steps, needed: 1 })
    }

    fn check_label(&self, column: &str) -> Option<DataError> {
        let labels = self.column(column);
        let k = labels.iter().position(|&value| value != 0.0 && value != 1.0)?;
        let (path, row, column, value) = (self.path(), self.row(k), column.to_string(), labels[k]);
        Some(DataError::NoLabel { path, row, column, value })
    }

    /// Its windows, or all of it.
    fn sequences(&self, rules: Rules) -> Vec<Sequence> {
        let seen = self.seen();
        let elapsed = self.elapsed_of(&seen);
        let windows = self.tables.windows.map_or(vec![0..seen.len()], |windows| windows.of(seen.len()));
        let whole = windows.len() == 1 && windows[0].len() == seen.len();
        let cut = |window: Range<usize>| Sequence {
            name: if whole { self.name.into() } else { window::name(self.name, window.start) },
            elapsed: elapsed[window.clone()].to_vec(),
            inputs: self.matrix(&self.tables.inputs, &seen[window.clone()], 0),
            targets: match rules.asked {
                Asked::Last => self.matrix(&self.tables.targets, &seen[window.end - 1..window.end], self.tables.ahead),
                Asked::Every => self.matrix(&self.tables.targets, &seen[window], self.tables.ahead),
            },
        };
        windows.into_iter().map(cut).collect()
    }

    /// Rows that are seen.
    fn seen(&self) -> Vec<usize> {
        let rows = 0..self.rows.len().saturating_sub(self.tables.ahead);
        let keep = self.tables.keep.as_deref().map(|column| self.column(column));
        rows.filter(|&row| keep.is_none_or(|keep| keep[row] != 0.0)).collect()
    }

    /// Columns at some rows, or so many later.
    fn matrix(&self, columns: &[String], rows: &[usize], later: usize) -> DMatrix<f64> {
        let columns: Vec<&[f64]> = columns.iter().map(|name| self.column(name)).collect();
        DMatrix::from_fn(rows.len(), columns.len(), |k, c| columns[c][rows[k] + later])
    }

    /// Elapsed times of the rows that are used: to the target, or across rows that were left out.
    fn elapsed_of(&self, seen: &[usize]) -> Vec<f64> {
        let rows = self.elapsed();
        if self.tables.keep.is_none() {
            return rows[self.tables.ahead..].to_vec();
        }
        let starts = std::iter::once(0).chain(seen.iter().map(|row| row + 1));
        starts.zip(seen).map(|(start, &row)| rows[start..=row].iter().sum()).collect()
    }

    /// Elapsed time of every row; the first row of a sequence has the median step.
    fn elapsed(&self) -> Vec<f64> {
        match (&self.tables.time, &self.tables.elapsed) {
            (Some(time), _) => {
                let time = self.seconds(time);
                #[expect(clippy::single_range_in_vec_init, reason = "one segment")]
                let first = median_step(&time, &[0..time.len()]);
                std::iter::once(first).chain(time.windows(2).map(|pair| pair[1] - pair[0])).collect()
            }
            (None, Some(elapsed)) => self.seconds(elapsed),
            (None, None) => vec![1.0; self.rows.len()],
        }
    }
}
