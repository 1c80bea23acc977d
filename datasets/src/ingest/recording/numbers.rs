//! Cells become numbers; what cannot is a problem with row, column and value. Cells of a column with the same problem are
//! one message: the first of them, how many more there are, and in which rows.

use std::collections::BTreeMap;
use std::path::Path;

use super::cells::{Cells, Texts};
use super::csv::decimal::Decimal;
use super::csv::missing::is_missing;
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
    /// Row in the file of a cell.
    pub row: &'a dyn Fn(usize) -> usize,
    pub may_be_empty: bool,
    /// It is the column of time.
    pub time: bool,
    /// How its numbers are written, if they are text.
    pub decimal: Decimal,
}

/// Spellings of missing values, and how often each occurs.
pub(crate) type Missing = BTreeMap<String, usize>;

impl Column<'_> {
    /// The column as numbers, NaN for a missing value; its spellings are counted.
    pub fn read(&self, cells: &Cells, missing: &mut Missing, problems: &mut Vec<DataError>) -> Vec<f64> {
        let mut found = Found::default();
        let mut number = |(i, cell): (usize, Option<f64>)| match cell.filter(|value| value.is_nan()) {
            Some(_) => self.spelled(i, "NaN", missing, &mut found),
            None => self.number(i, cell, &mut found),
        };
        let values = match cells {
            Cells::Numbers(cells) => cells.iter().copied().enumerate().map(number).collect(),
            Cells::Whole(cells) => {
                cells.iter().map(|cell| cell.map(|value| value as f64)).enumerate().map(number).collect()
            }
            Cells::Text(cells) => {
                let parse = |(i, cell): (usize, &str)| match is_missing(cell.trim()) && !cell.is_empty() {
                    true => self.spelled(i, cell.trim(), missing, &mut found),
                    false => self.parse(i, cell.trim(), &mut found),
                };
                cells.iter().enumerate().map(parse).collect()
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
            self.absent(i, "", &mut found);
        }
        report(found, problems);
    }

    /// The column as names of trials.
    pub fn labels(&self, cells: &Cells, problems: &mut Vec<DataError>) -> Vec<String> {
        let mut found = Found::default();
        let mut label = |(i, label): (usize, String)| {
            if label.is_empty() {
                self.absent(i, "", &mut found);
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

    /// A missing value that is written as a word.
    fn spelled(&self, i: usize, cell: &str, missing: &mut Missing, found: &mut Found) -> f64 {
        *missing.entry(cell.to_string()).or_insert(0) += 1;
        self.absent(i, cell, found)
    }

    fn number(&self, i: usize, cell: Option<f64>, found: &mut Found) -> f64 {
        match cell {
            Some(value) if value.is_finite() => self.within(i, value, found),
            Some(value) => self.not_finite(i, &value.to_string(), found),
            None => self.absent(i, "", found),
        }
    }

    fn parse(&self, i: usize, cell: &str, found: &mut Found) -> f64 {
        if cell.is_empty() {
            return self.absent(i, "", found);
        }
        match self.decimal.number(cell) {
            Some(value) if value.is_finite() => self.within(i, value, found),
            Some(_) => self.not_finite(i, cell, found),
            None => {
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

    fn absent(&self, i: usize, cell: &str, found: &mut Found) -> f64 {
        if !self.may_be_empty {
            let (path, column, row) = self.place(i);
            let (what, more) = match cell {
                "" => ("the cell is empty".to_string(), More::default()),
                word => (format!("{word:?} is a missing value"), More::default()),
            };
            found.refuse(Cause::Empty, row, || DataError::EmptyCell { path, row, column, what, more });
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
        (self.path.to_path_buf(), self.name.to_string(), (self.row)(i))
    }
}

/// The numbers of a column of text, in which values may be missing.
pub(crate) fn numbers_of(
    path: &Path,
    name: &str,
    row: &dyn Fn(usize) -> usize,
    texts: Texts,
    decimal: Decimal,
    missing: &mut Missing,
    problems: &mut Vec<DataError>,
) -> Vec<f64> {
    let column = Column { path, name, row, may_be_empty: true, time: false, decimal };
    column.read(&Cells::Text(texts), missing, problems)
}

/// How missing values are spelled, as a sentence.
pub(crate) fn spelled(missing: &Missing) -> Option<String> {
    let counted: Vec<String> = missing.iter().map(|(cell, count)| format!("{cell:?} ({count} times)")).collect();
    (!counted.is_empty()).then(|| format!("missing values are written {}", counted.join(", ")))
}

/// The name of a trial that is a number: without a point where it is a whole one.
fn name(cell: &Option<impl ToString>) -> String {
    cell.as_ref().map_or(String::new(), ToString::to_string)
}

fn report(found: Found, problems: &mut Vec<DataError>) {
    problems.extend(found.0.into_iter().map(|(_, problem)| problem));
}
