//! One data file as columns of numbers, before any meaning is given to them.
//!
//! CSV and Parquet are read by polars into the same [`Recording`]: each wanted column is an `f64` vector in the file's
//! own unit, and NaN stands for an empty cell (a NaN that the file itself contains is a problem, not an empty cell).

mod csv;
mod numbers;
mod parquet;

pub(crate) use parquet::{check_ends, guarded};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use polars::prelude::DataFrame;

use crate::error::DataError;
use crate::locate::FILE_LIMIT;

/// The wanted columns of one file.
#[derive(Debug, Clone)]
pub(crate) struct Recording {
    /// The file.
    pub path: PathBuf,
    /// How many samples.
    pub rows: usize,
    /// The number of the first sample's row.
    pub first_row: usize,
    /// Numbers by column; NaN is an empty cell.
    pub numbers: BTreeMap<String, Vec<f64>>,
    /// The column of trial names.
    pub labels: Option<Vec<String>>,
}

/// What to read from a file.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// Columns of numbers, and whether a cell may be empty.
    pub numbers: BTreeMap<String, bool>,
    /// Column of trial names.
    pub label: Option<String>,
    /// Separator of CSV cells.
    pub separator: u8,
}

/// The bytes of a file, which are hashed and parsed.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, DataError> {
    let failed = |e: std::io::Error| DataError::file_system("read", path, &e);
    let size = std::fs::metadata(path).map_err(failed)?.len();
    if size > FILE_LIMIT {
        let remedy = "split the recording into one file per trial";
        return Err(DataError::TooLarge { path: path.to_path_buf(), bytes: size, limit: FILE_LIMIT, remedy });
    }
    std::fs::read(path).map_err(failed)
}

/// Reads a file; what is wrong with it goes to `problems`.
pub(crate) fn read(path: &Path, bytes: Vec<u8>, wanted: &Wanted, problems: &mut Vec<DataError>) -> Option<Recording> {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    let read = match extension.as_deref().and_then(|e| e.to_str()) {
        Some("csv") => csv::read(path, bytes, wanted).map(|frame| (frame, 2)),
        Some("parquet") => parquet::read(path, bytes, wanted).map(|frame| (frame, 1)),
        _ => Err(DataError::UnknownExtension { path: path.to_path_buf() }),
    };
    match read {
        Ok((frame, first_row)) => gather(path, &frame, first_row, wanted, problems),
        Err(error) => {
            problems.extend(error.problems());
            None
        }
    }
}

fn gather(
    path: &Path,
    frame: &DataFrame,
    first_row: usize,
    wanted: &Wanted,
    problems: &mut Vec<DataError>,
) -> Option<Recording> {
    let before = problems.len();
    if frame.height() == 0 {
        problems.push(DataError::NoRows { path: path.to_path_buf() });
        return None;
    }
    let mut columns = BTreeMap::new();
    for (name, may_be_empty) in &wanted.numbers {
        let column = numbers::Column { path, name, first_row, may_be_empty: *may_be_empty };
        columns.insert(name.clone(), column.read(frame, problems));
    }
    let labels = wanted.label.as_ref().map(|name| {
        let column = numbers::Column { path, name, first_row, may_be_empty: false };
        column.labels(frame, problems)
    });
    let rows = frame.height();
    (problems.len() == before).then(|| Recording {
        path: path.to_path_buf(),
        rows,
        first_row,
        numbers: columns,
        labels,
    })
}

impl Wanted {
    /// Every column that must be there.
    fn columns(&self) -> Vec<&str> {
        let label = self.label.as_deref().filter(|l| !self.numbers.contains_key(*l));
        self.numbers.keys().map(String::as_str).chain(label).collect()
    }

    /// Columns that are missing or doubled in a header.
    fn check_header(&self, path: &Path, header: &[String]) -> Result<(), DataError> {
        let mut problems = Vec::new();
        for column in self.columns() {
            let (path, column) = (path.to_path_buf(), column.to_string());
            match header.iter().filter(|h| **h == column).count() {
                1 => {}
                0 => problems.push(DataError::MissingColumn { path, column, known: list(header) }),
                count => problems.push(DataError::DoubledColumn { path, column, count }),
            }
        }
        crate::error::Problems(problems).into_result()
    }
}

fn list(header: &[String]) -> String {
    let shown: Vec<String> = header.iter().take(40).map(|h| format!("`{}`", crate::error::short(h))).collect();
    let more = if header.len() > 40 { format!(" and {} more", header.len() - 40) } else { String::new() };
    shown.join(" ") + &more
}
