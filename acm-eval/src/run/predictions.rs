//! Prediction tables: measured values and predictions of each estimator, one row per target time stamp.
//!
//! Columns `trial`, `part`, `time` (s), then per output `o`: `measured_o`, `nominal_o`, `polynomial_o`, `predicted_o`,
//! all in the output's SI unit.

use std::{collections::BTreeMap, ops::Range, path::Path};

use acm_datasets::DataError;
use acm_datasets::files::table::{Column, read_parquet};
use acm_train::store::hashed;

use crate::error::EvalError;

/// Predictions for the trials that took no part in learning.
pub const HELD_OUT: &str = "held_out";
/// Predictions for the trials that chose the epoch.
pub const VALIDATION: &str = "validation";

/// One prediction table, columns by name. All columns have `rows` entries.
#[derive(Debug, Clone)]
pub struct Predictions {
    trial: Vec<String>,
    part: Vec<String>,
    time: Vec<f64>,
    values: BTreeMap<String, Vec<f64>>,
}

/// One trial of one part: rows of the table, in order of time.
#[derive(Debug, Clone)]
pub struct TrialRows<'a> {
    /// Name of the trial.
    pub trial: &'a str,
    /// Rows of the table.
    pub rows: Range<usize>,
}

impl Predictions {
    /// Reads the table at `path`, which must have the columns of `outputs`.
    ///
    /// # Errors
    /// No such file, not a Parquet file, or a column that is missing or of the wrong kind; the message names both.
    pub fn read(path: &Path, outputs: &[String]) -> Result<Self, EvalError> {
        if !path.is_file() {
            return Err(EvalError::MissingPredictions { path: path.into() });
        }
        let columns = read_parquet(path).map_err(|source| unreadable(path, source))?;
        let mut columns: BTreeMap<String, Column> = columns.into_iter().collect();
        let mut values = BTreeMap::new();
        for output in outputs {
            for estimate in ["measured", "nominal", "polynomial", "predicted"] {
                let name = format!("{estimate}_{output}");
                values.insert(name.clone(), take_numbers(&mut columns, &name, path)?);
            }
        }
        Ok(Self {
            trial: take_text(&mut columns, "trial", path)?,
            part: take_text(&mut columns, "part", path)?,
            time: take_numbers(&mut columns, "time", path)?,
            values,
        })
    }

    /// Returns the trials of one part, in the order of the table.
    pub fn trials(&self, part: &str) -> Vec<TrialRows<'_>> {
        let mut found: Vec<TrialRows> = Vec::new();
        for row in (0..self.trial.len()).filter(|&row| self.part[row] == part) {
            match found.last_mut() {
                Some(last) if last.trial == self.trial[row] && last.rows.end == row => last.rows.end += 1,
                _ => found.push(TrialRows { trial: &self.trial[row], rows: row..row + 1 }),
            }
        }
        found
    }

    /// Returns the time stamps, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Returns the column `<estimate>_<output>`, in the output's SI unit; `estimate` is `measured`, `nominal`,
    /// `polynomial` or `predicted`.
    ///
    /// # Panics
    /// Where the output is none of those the table was read with.
    pub fn column(&self, estimate: &str, output: &str) -> &[f64] {
        &self.values[&format!("{estimate}_{output}")]
    }

    /// Returns the distance between an estimate and the measurement at one row, over all `outputs`.
    pub fn distance(&self, estimate: &str, outputs: &[String], row: usize) -> f64 {
        let square =
            |output: &String| (self.column("measured", output)[row] - self.column(estimate, output)[row]).powi(2);
        outputs.iter().map(square).sum::<f64>().sqrt()
    }
}

/// Checks that a table is still the one whose hash its record holds.
///
/// # Errors
/// It is missing, cannot be read, or was changed.
pub fn unchanged(path: &Path, noted: &str) -> Result<(), EvalError> {
    if !path.is_file() {
        return Err(EvalError::MissingPredictions { path: path.into() });
    }
    match hashed::of_file(path)? == noted {
        true => Ok(()),
        false => {
            let reason = "it is not the table whose SHA-256 its record holds".into();
            Err(EvalError::Predictions { path: path.into(), reason })
        }
    }
}

/// Converts the error of a damaged table. It can be made again, which recordings cannot: the remedy is another.
fn unreadable(path: &Path, source: DataError) -> EvalError {
    match source {
        DataError::Damaged { reason, .. } => EvalError::Predictions { path: path.into(), reason },
        other => EvalError::Table(other),
    }
}

fn take_text(columns: &mut BTreeMap<String, Column>, name: &str, path: &Path) -> Result<Vec<String>, EvalError> {
    match columns.remove(name) {
        Some(Column::Text(values)) => Ok(values),
        other => Err(bad_column(name, "text", other.is_some(), path)),
    }
}

fn take_numbers(columns: &mut BTreeMap<String, Column>, name: &str, path: &Path) -> Result<Vec<f64>, EvalError> {
    match columns.remove(name) {
        Some(Column::Number(values)) => match values.iter().position(|v| !v.is_finite()) {
            None => Ok(values),
            Some(row) => {
                let reason = format!("column `{name}`, row {}: {} is no number", row + 1, values[row]);
                Err(EvalError::Predictions { path: path.into(), reason })
            }
        },
        other => Err(bad_column(name, "numbers", other.is_some(), path)),
    }
}

fn bad_column(name: &str, wanted: &str, present: bool, path: &Path) -> EvalError {
    let reason = match present {
        true => format!("column `{name}` does not hold {wanted}"),
        false => format!("there is no column `{name}`"),
    };
    EvalError::Predictions { path: path.into(), reason }
}
