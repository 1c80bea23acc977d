//! Cells become numbers; what cannot is a problem with row, column and value. Cells of a column with the same problem are
//! one message: the first of them, how many more there are, and in which rows.

use std::path::Path;

use super::cells::Cells;
use super::header::visible;
use super::written::written;
use crate::error::{DataError, More, shown};

/// A number beyond it is none that was measured; squares of greater ones are infinite before long.
const FARTHEST: f64 = 1e30;

/// The problems of one column, the first of each kind with its cause.
#[derive(Default)]
struct Found(Vec<(Cause, DataError)>);

/// Problems with the same words.
#[derive(PartialEq, Eq, Clone, Copy)]
enum Cause {
    Empty,
    NotFinite,
    TooFar,
    Control,
    Written(&'static str, &'static str),
}

impl Found {
    /// Notes a problem of a cell; what stands in the cell's place.
    fn refuse(&mut self, cause: Cause, row: usize, problem: impl FnOnce() -> DataError) -> f64 {
        match self.0.iter_mut().find(|(before, _)| *before == cause) {
            Some((_, first)) => {
                if let Some(more) = first.more() {
                    more.add(row);
                }
            }
            None => self.0.push((cause, problem())),
        }
        f64::NAN
    }
}

/// A column that is being read.
pub(super) struct Column<'a> {
    pub path: &'a Path,
    pub name: &'a str,
    pub first_row: usize,
    pub may_be_empty: bool,
    /// It is the column of time.
    pub time: bool,
}

impl Column<'_> {
    /// The column as numbers, NaN for an empty cell.
    pub fn read(&self, cells: &Cells, problems: &mut Vec<DataError>) -> Vec<f64> {
        let mut found = Found::default();
        let mut number = |(i, cell): (usize, Option<f64>)| self.number(i, cell, &mut found);
        let values = match cells {
            Cells::Numbers(cells) => cells.iter().copied().enumerate().map(number).collect(),
            Cells::Whole(cells) => {
                cells.iter().map(|cell| cell.map(|value| value as f64)).enumerate().map(number).collect()
            }
            Cells::Text(cells) => {
                cells.iter().enumerate().map(|(i, cell)| self.parse(i, cell.trim(), &mut found)).collect()
            }
            Cells::Ticks(..) => (0..cells.len()).map(|i| number((i, None))).collect(),
        };
        report(found, problems);
        values
    }

    /// Time of a type of its own has no empty cells.
    pub fn check_ticks(&self, values: &[Option<i64>], problems: &mut Vec<DataError>) {
        let mut found = Found::default();
        for (i, _) in values.iter().enumerate().filter(|(_, tick)| tick.is_none()) {
            self.absent(i, &mut found);
        }
        report(found, problems);
    }

    /// The column as names of trials.
    pub fn labels(&self, cells: &Cells, problems: &mut Vec<DataError>) -> Vec<String> {
        let mut found = Found::default();
        let mut label = |(i, label): (usize, String)| {
            if label.is_empty() {
                self.absent(i, &mut found);
            } else if label.contains(char::is_control) {
                self.control(i, &label, &mut found);
                return visible(&label);
            }
            label
        };
        let labels = match cells {
            Cells::Text(cells) => cells.iter().map(|cell| cell.trim().to_string()).enumerate().map(label).collect(),
            Cells::Numbers(cells) => cells.iter().map(name).enumerate().map(label).collect(),
            Cells::Whole(cells) => cells.iter().map(name).enumerate().map(label).collect(),
            Cells::Ticks(_, cells) => cells.iter().map(name).enumerate().map(&mut label).collect(),
        };
        report(found, problems);
        labels
    }

    fn number(&self, i: usize, cell: Option<f64>, found: &mut Found) -> f64 {
        match cell {
            Some(value) if value.is_finite() => self.within(i, value, found),
            Some(value) => self.not_finite(i, &value.to_string(), found),
            None => self.absent(i, found),
        }
    }

    fn parse(&self, i: usize, cell: &str, found: &mut Found) -> f64 {
        if cell.is_empty() {
            return self.absent(i, found);
        }
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => self.within(i, value, found),
            Ok(_) => self.not_finite(i, cell, found),
            Err(_) => {
                let (what, remedy) = written(cell, self.time);
                let (path, column, row) = self.place(i);
                let (value, more) = (shown(cell), More::default());
                let problem = || DataError::NotANumber { path, row, column, value, what, remedy, more };
                found.refuse(Cause::Written(what, remedy), row, problem)
            }
        }
    }

    /// A number whose square still is one.
    fn within(&self, i: usize, value: f64, found: &mut Found) -> f64 {
        if value.abs() <= FARTHEST {
            return value;
        }
        let (path, column, row) = self.place(i);
        found.refuse(Cause::TooFar, row, || DataError::TooFar { path, row, column, value, more: More::default() })
    }

    fn absent(&self, i: usize, found: &mut Found) -> f64 {
        if !self.may_be_empty {
            let (path, column, row) = self.place(i);
            let more = More::default();
            found.refuse(Cause::Empty, row, || DataError::EmptyCell { path, row, column, more });
        }
        f64::NAN
    }

    /// A name that is printed.
    fn control(&self, i: usize, label: &str, found: &mut Found) {
        let (path, column, row) = self.place(i);
        let what = format!("the trial's name `{}` in column `{column}` has control characters", shown(&visible(label)));
        let problem = || DataError::BadText { path, row, what, remedy: "give it a name of letters and digits" };
        found.refuse(Cause::Control, row, problem);
    }

    fn not_finite(&self, i: usize, value: &str, found: &mut Found) -> f64 {
        let (path, column, row) = self.place(i);
        let (value, more) = (shown(value), More::default());
        found.refuse(Cause::NotFinite, row, || DataError::NotFinite { path, row, column, value, more })
    }

    fn place(&self, i: usize) -> (std::path::PathBuf, String, usize) {
        (self.path.to_path_buf(), self.name.to_string(), self.first_row + i)
    }
}

/// The name of a trial that is a number: without a point where it is a whole one.
fn name(cell: &Option<impl ToString>) -> String {
    cell.as_ref().map_or(String::new(), ToString::to_string)
}

fn report(found: Found, problems: &mut Vec<DataError>) {
    problems.extend(found.0.into_iter().map(|(_, problem)| problem));
}
