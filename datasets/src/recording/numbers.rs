//! Cells become numbers; each cell that cannot is a problem with its row, column and value.

use std::path::Path;

use polars_core::prelude::*;

use crate::error::{DataError, shown};

/// How many cells of one column and file are listed before the rest is only counted.
const LISTED: usize = 10;

/// A number beyond it is none that was measured; squares of greater ones are infinite before long.
const FARTHEST: f64 = 1e30;

/// What writes numbers so, and how they are written.
fn hint(cell: &str) -> &'static str {
    let number = |text: String| text.parse::<f64>().is_ok();
    if number(cell.replace(',', ".")) {
        " (write a decimal point)"
    } else if number(cell.replace('\u{2212}', "-").replace(['\u{2013}', '\u{2014}'], "-")) {
        " (write the sign as a hyphen)"
    } else if number(cell.replace(['\'', ' ', '_', '\u{a0}', '\u{202f}', '\u{2009}'], "")) {
        " (write it without separators between thousands)"
    } else if number(cell.replace(['d', 'D'], "e")) {
        " (write the exponent with e)"
    } else if number(cell.trim_end_matches(|c: char| c.is_alphabetic() || "%°/ ".contains(c)).to_string()) {
        " (the unit belongs into the manifest)"
    } else {
        ""
    }
}

/// The problems of one column: the first few, and how many more.
#[derive(Default)]
struct Found {
    listed: Vec<DataError>,
    more: usize,
}

impl Found {
    fn push(&mut self, problem: DataError) {
        match self.listed.len() < LISTED {
            true => self.listed.push(problem),
            false => self.more += 1,
        }
    }

    /// What stands where the problem was found.
    fn refuse(&mut self, problem: DataError) -> f64 {
        self.push(problem);
        f64::NAN
    }
}

/// A column that is being read.
pub(super) struct Column<'a> {
    pub path: &'a Path,
    pub name: &'a str,
    pub first_row: usize,
    pub may_be_empty: bool,
}

impl Column<'_> {
    /// The column as numbers, NaN for an empty cell.
    pub fn read(&self, frame: &DataFrame, problems: &mut Vec<DataError>) -> Vec<f64> {
        let mut found = Found::default();
        let values = match self.values(frame, &mut found) {
            Some(values) => values,
            None => {
                let kind = frame.column(self.name).map_or(String::new(), |c| c.dtype().to_string());
                let (path, column) = (self.path.to_path_buf(), self.name.to_string());
                found.push(DataError::WrongType { path, column, kind });
                Vec::new()
            }
        };
        self.report(found, problems);
        values
    }

    /// The column as names of trials.
    pub fn labels(&self, frame: &DataFrame, problems: &mut Vec<DataError>) -> Vec<String> {
        let column = frame.column(self.name).map(polars_core::prelude::Column::as_materialized_series);
        let decimal = column.as_ref().is_ok_and(|c| c.dtype().is_float());
        let text = column.and_then(|c| c.cast(&DataType::String));
        let mut found = Found::default();
        let mut labels = Vec::with_capacity(frame.height());
        if let Ok(Ok(cells)) = text.as_ref().map(|t| t.str()) {
            for (i, cell) in cells.iter().enumerate() {
                let label = cell.unwrap_or("").trim();
                let label = if decimal { label.trim_end_matches(".0") } else { label };
                if label.is_empty() {
                    found.push(self.empty(i));
                }
                labels.push(label.to_string());
            }
        }
        self.report(found, problems);
        labels
    }

    fn values(&self, frame: &DataFrame, found: &mut Found) -> Option<Vec<f64>> {
        let series = frame.column(self.name).ok()?.as_materialized_series();
        let mut values = Vec::with_capacity(series.len());
        if let Ok(cells) = series.str() {
            for (i, cell) in cells.iter().enumerate() {
                values.push(self.parse(i, cell.unwrap_or("").trim(), found));
            }
            return Some(values);
        }
        if !series.dtype().is_primitive_numeric() {
            return None;
        }
        let cast = series.cast(&DataType::Float64).ok()?;
        for (i, cell) in cast.f64().ok()?.iter().enumerate() {
            values.push(match cell {
                Some(value) if value.is_finite() => self.within(i, value, found),
                Some(value) => found.refuse(self.not_finite(i, &value.to_string())),
                None => self.absent(i, found),
            });
        }
        Some(values)
    }

    fn parse(&self, i: usize, cell: &str, found: &mut Found) -> f64 {
        if cell.is_empty() {
            return self.absent(i, found);
        }
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => self.within(i, value, found),
            Ok(_) => found.refuse(self.not_finite(i, cell)),
            Err(_) => {
                let hint = hint(cell);
                let (path, column) = (self.path.to_path_buf(), self.name.to_string());
                let (row, value) = (self.first_row + i, shown(cell));
                found.refuse(DataError::NotANumber { path, row, column, value, hint })
            }
        }
    }

    /// A number whose square still is one.
    fn within(&self, i: usize, value: f64, found: &mut Found) -> f64 {
        if value.abs() <= FARTHEST {
            return value;
        }
        let (path, column) = (self.path.to_path_buf(), self.name.to_string());
        found.refuse(DataError::TooFar { path, row: self.first_row + i, column, value })
    }

    fn absent(&self, i: usize, found: &mut Found) -> f64 {
        if !self.may_be_empty {
            found.push(self.empty(i));
        }
        f64::NAN
    }

    fn empty(&self, i: usize) -> DataError {
        let (path, column) = (self.path.to_path_buf(), self.name.to_string());
        DataError::EmptyCell { path, row: self.first_row + i, column }
    }

    fn not_finite(&self, i: usize, value: &str) -> DataError {
        let (path, column) = (self.path.to_path_buf(), self.name.to_string());
        DataError::NotFinite { path, row: self.first_row + i, column, value: shown(value) }
    }

    fn report(&self, found: Found, problems: &mut Vec<DataError>) {
        problems.extend(found.listed);
        if found.more > 0 {
            let (path, column) = (self.path.to_path_buf(), self.name.to_string());
            problems.push(DataError::AndMore { path, column, count: found.more });
        }
    }
}
