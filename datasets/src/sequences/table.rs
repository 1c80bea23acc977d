//! Sequences from tables: one row a step, in CSV or Parquet.
//!
//! ```text
//! step k sees       inputs_k
//! target of step k  targets_{k+a}             a = `ahead`; the last a rows are not used
//! elapsed of step k t_{k+a} − t_{k+a−1}       the time until the target; the first is the median step
//! ```
//!
//! With a = 1 a network at step k receives the time until the target. A sequence is a run of rows with the same
//! name, or a file. Everything that is wrong is listed with file, row, column and value.
//!
//! Where a column says which rows are seen (`keep`), the others are left out, and may still be asked for:
//!
//! ```text
//! elapsed of step k t_k − t_j                 j: the row that was seen before; the first also has the median step
//! ```
//!
//! `windows` cuts what is left of each sequence. All windows of a sequence are in one part.

mod parts;
mod steps;
mod window;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
pub use window::{Windows, whole};

use super::{Asked, SequenceSet};
use crate::checks::plausible::wrong_step;
use crate::error::{DataError, Problems};
use crate::ingest::recording::csv::signs::{WrongSign, wrong_sign};
use crate::ingest::recording::{self, Recording, TimeColumn, Wanted};
use crate::join::median;
use crate::units::{Dimension, Unit};

/// Which files, and what their columns are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tables {
    /// Where the files lie: as seen from the current directory, else from the experiment file's folder or one above it.
    pub folder: PathBuf,
    /// File names or patterns within the folder.
    pub files: Vec<String>,
    /// Separator of CSV cells, one character; recognised if it is omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub separator: Option<String>,
    /// Decimal separator in CSV, `","` or `"."`; recognised if it is omitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimal: Option<String>,
    /// Column of the sequence's name. Left out: each file is one sequence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sequence: Option<String>,
    /// Column of time stamps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Alternative to `time`: column of the time since the previous row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elapsed: Option<String>,
    /// Unit of either column; `None` for s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_unit: Option<String>,
    /// Columns that are seen.
    pub inputs: Vec<String>,
    /// Wanted columns.
    pub targets: Vec<String>,
    /// How many rows later: 1 is the prediction of the next step.
    pub ahead: usize,
    /// Column of 0 and 1: rows with 0 are not seen. Left out: all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep: Option<String>,
    /// Column that says `training`, `validation` or `test`. Left out: shares of the sequences, drawn by `seed`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Share of the sequences that chooses the epoch.
    pub validation: f64,
    /// Share of the sequences that is looked at once.
    pub test: f64,
    /// Decides which sequences these are.
    pub seed: u64,
    /// Pieces of each sequence, which are learned from and asked about one by one. Left out: whole sequences.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub windows: Option<Windows>,
}

impl Default for Tables {
    fn default() -> Self {
        Self {
            folder: ".".into(),
            files: vec!["*.csv".into()],
            separator: None,
            decimal: None,
            sequence: None,
            time: None,
            elapsed: None,
            time_unit: None,
            inputs: vec![],
            targets: vec![],
            ahead: 0,
            keep: None,
            part: None,
            validation: 0.2,
            test: 0.2,
            seed: 1,
            windows: None,
        }
    }
}

impl Tables {
    /// Returns the unit of time; `None` if `time_unit` names no such unit.
    pub fn unit_of_time(&self) -> Option<Unit> {
        let unit = Unit::parse(self.time_unit.as_deref().unwrap_or("s")).ok()?;
        (unit.dimension == Dimension::Time).then_some(unit)
    }

    /// Returns what is wrong with `separator` or `decimal`.
    pub fn wrong_sign(&self) -> Option<WrongSign> {
        wrong_sign(self.separator.as_deref(), self.decimal.as_deref())
    }

    /// Returns whether a folder has a file of each pattern.
    pub fn lies_in(&self, folder: &Path) -> bool {
        files(self, folder).is_ok()
    }

    /// Returns a warning if the median step of the training part cannot be right.
    pub fn implausible_step(&self, set: &SequenceSet) -> Option<String> {
        let column = self.time.as_ref().or(self.elapsed.as_ref())?;
        let steps: Vec<f64> = set.training.iter().flat_map(|one| &one.elapsed).copied().collect();
        let wrong = wrong_step(&self.unit_of_time()?, median(&steps))?;
        Some(format!("warning: column `{column}` {wrong}: write the unit as time_unit in [data]"))
    }
}

/// Rules for the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rules {
    /// Steps that are asked about.
    pub asked: Asked,
    /// Whether targets must be 0 or 1.
    pub labels: bool,
}

/// Reads the tables in `folder`.
///
/// # Errors
/// All problems of the files at once.
pub fn read(tables: &Tables, folder: &Path, rules: Rules) -> Result<SequenceSet, DataError> {
    let mut problems = vec![];
    let mut named = vec![];
    for path in files(tables, folder)? {
        let mut column = |name: &Option<String>, numbers: &BTreeMap<String, bool>| {
            let (separator, decimal) = (sign(&tables.separator), sign(&tables.decimal));
            let time = tables.time.clone().filter(|time| numbers.contains_key(time));
            let time = time.map(|column| TimeColumn { column, unit: Some("s".into()), counts: false });
            let wanted = Wanted { numbers: numbers.clone(), label: name.clone(), time, separator, decimal };
            recording::read(&path, &wanted, &mut problems)
        };
        let Some(mut numbers) = column(&tables.sequence, &wanted(tables)) else { continue };
        if let (Some(ticks), Some(time)) = (&numbers.ticks, &tables.time) {
            let seconds = ticks.seconds(&(0..numbers.rows).collect::<Vec<_>>());
            let unit = tables.unit_of_time().map_or(1.0, |unit| unit.factor()); // it is converted with the others
            numbers.numbers.insert(time.clone(), seconds.iter().map(|time| time / unit).collect());
        }
        let parts = match &tables.part {
            None => None,
            some => match column(some, &BTreeMap::new()) {
                Some(read) => read.labels,
                None => continue,
            },
        };
        named.extend(steps::cut(tables, rules, &Table { numbers, parts }, &mut problems));
    }
    refuse_twins(&named, &mut problems);
    Problems(problems).into_result()?;
    let [training, validation, test] = parts::deal(tables, named);
    let (channels, outputs) = (tables.inputs.clone(), tables.targets.clone());
    Ok(SequenceSet { channels, outputs, asked: rules.asked, training, validation, test })
}

fn sign(text: &Option<String>) -> Option<char> {
    text.as_deref().and_then(|text| text.chars().next())
}

/// One file.
struct Table {
    numbers: Recording,
    parts: Option<Vec<String>>,
}

fn wanted(tables: &Tables) -> BTreeMap<String, bool> {
    let columns = tables.inputs.iter().chain(&tables.targets).chain(&tables.time).chain(&tables.elapsed);
    let columns = columns.chain(&tables.keep);
    columns.map(|name| (name.clone(), false)).collect()
}

/// All files, sorted.
fn files(tables: &Tables, folder: &Path) -> Result<Vec<PathBuf>, DataError> {
    let mut all = vec![];
    for pattern in &tables.files {
        let full = format!("{}/{pattern}", glob::Pattern::escape(&folder.display().to_string()));
        let found = glob::glob(&full).map(|paths| paths.filter_map(Result::ok).filter(|p| !p.is_dir()).collect());
        let found: Vec<PathBuf> = found.unwrap_or_default();
        if found.is_empty() {
            let what = format!("{}: `data.files` names {pattern:?}, which matches no file", folder.display());
            return Err(DataError::Usage(what + "; correct the pattern, or put the files there"));
        }
        all.extend(found);
    }
    all.sort();
    all.dedup();
    Ok(all)
}

/// A name that comes back in another file is taken for a mistake.
fn refuse_twins(named: &[steps::Cut], problems: &mut Vec<DataError>) {
    let mut seen = BTreeMap::<&str, &Path>::new();
    for cut in named {
        if let Some(first) = seen.insert(&cut.name, &cut.path).filter(|first| *first != cut.path) {
            let (trial, first, second) = (cut.name.clone(), first.to_path_buf(), cut.path.clone());
            problems.push(DataError::TrialInTwoFiles { trial, first, second });
        }
    }
}
