//! A table of a descriptive study: the columns that its figures are drawn from, by name.

use std::{collections::BTreeMap, path::Path};

use acm_datasets::DataError;
use acm_datasets::files::table::{Column, read_parquet};
use acm_train::{config::Kind, store::hashed};
use serde::{Deserialize, de::DeserializeOwned};

use crate::{error::EvalError, json::versioned};

/// Columns of one length.
#[derive(Debug, Clone)]
pub struct StudyTable {
    trial: Vec<String>,
    values: BTreeMap<String, Vec<f64>>,
}

impl StudyTable {
    /// Reads `predictions/<name>.parquet` of a study's folder, which must have the columns of `needed`; its record noted the
    /// hash of each of its `tables`.
    ///
    /// # Errors
    /// No such table, a damaged one, or one without a column that is needed.
    pub fn read(
        folder: &Path,
        name: &str,
        tables: &BTreeMap<String, String>,
        needed: &[String],
    ) -> Result<Self, EvalError> {
        let path = folder.join("predictions").join(format!("{name}.parquet"));
        if !path.is_file() {
            return Err(again(&path, "the table is missing".into()));
        }
        if tables.get(name) != Some(&hashed::of_file(&path)?) {
            return Err(again(&path, "it is not the table whose SHA-256 study.json holds".into()));
        }
        let columns = read_parquet(&path).map_err(|error| match error {
            DataError::Damaged { reason, .. } => again(&path, reason),
            other => EvalError::Table(other),
        })?;
        let mut table = Self { trial: vec![], values: BTreeMap::new() };
        for (column, values) in columns {
            match values {
                Column::Number(numbers) if numbers.iter().all(|number| number.is_finite()) => {
                    table.values.insert(column, numbers);
                }
                Column::Number(_) => return Err(again(&path, format!("column `{column}` has what is no number"))),
                Column::Text(text) if column == "trial" => table.trial = text,
                Column::Text(_) => {}
            }
        }
        match needed.iter().find(|column| !table.values.contains_key(*column)) {
            Some(column) => Err(again(&path, format!("there is no column `{column}`"))),
            None => Ok(table),
        }
    }

    /// Returns a column that [`StudyTable::read`] has read; empty for any other.
    pub fn column(&self, name: &str) -> &[f64] {
        self.values.get(name).map_or(&[], Vec::as_slice)
    }

    /// Returns the rows of a trial, in order of time.
    pub fn rows(&self, trial: &str) -> Vec<usize> {
        (0..self.trial.len()).filter(|&row| self.trial[row] == trial).collect()
    }
}

/// Returns `<estimate>_<output>` for every output.
pub fn columns(estimates: &[String], outputs: &[String]) -> Vec<String> {
    estimates.iter().flat_map(|estimate| outputs.iter().map(move |output| format!("{estimate}_{output}"))).collect()
}

/// Reads `study.json` of a folder, where it is a study of this kind.
///
/// # Errors
/// No study, one of another kind, or a damaged one.
pub fn record<T: DeserializeOwned>(folder: &Path, wanted: Kind, word: &str) -> Result<T, EvalError> {
    #[derive(Deserialize)]
    struct Asked {
        kind: Kind,
    }
    let file = folder.join("study.json");
    if !folder.is_dir() {
        return Err(EvalError::NoFolder { path: folder.into() });
    }
    if !file.is_file() {
        return Err(EvalError::NotARun { path: folder.into(), missing: "study.json" });
    }
    match versioned::<Asked>(&file)?.kind {
        kind if kind == wanted => versioned(&file),
        _ => Err(EvalError::Usage(format!(
            "{}: the study there is of another kind than \"{word}\"; give the folder of experiments/{word}.toml",
            folder.display()
        ))),
    }
}

/// Returns the error of a table that the same study can write again.
fn again(path: &Path, reason: String) -> EvalError {
    EvalError::Usage(format!("{}: {reason}; run the study again with `acm-train --resume`", path.display()))
}
