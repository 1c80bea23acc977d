//! A study of sequences as a table and a figure: the effect of elapsed times.
//!
//! ```text
//! study.json, records/*.json ─ read ─▶ Study ─┬─ table  ─▶ a line for each row of the question
//!                                             └─ figure ─▶ loss of training and validation per epoch
//! ```

mod learning;
mod table;

use std::{collections::BTreeMap, path::Path};

use acm_train::{
    config::Elapsed,
    run::{
        record::DataStamp,
        sequences::record::{DataRecord, SequenceRecord, StudyRecord},
        sequences::table::{ROWS, told},
    },
};

use crate::error::EvalError;
use crate::figures::Drawing;
use crate::json::versioned;
use crate::run::predictions::unchanged;
use crate::tables::Table;

/// A study with its runs.
#[derive(Debug)]
pub struct Study {
    /// Configuration and sequences.
    pub record: StudyRecord,
    /// Every run, by row and seed.
    pub runs: Vec<SequenceRecord>,
    /// Origin of the sequences, in the form of other data.
    pub data: DataStamp,
}

/// Reads the folder of a study of sequences.
///
/// # Errors
/// A file is missing or damaged, or no run is finished.
pub fn read(folder: &Path) -> Result<Study, EvalError> {
    let record: StudyRecord = versioned(&folder.join("study.json"))?;
    let records = folder.join("records");
    let entries = std::fs::read_dir(&records).map_err(|source| EvalError::read(&records, source))?;
    let mut files: Vec<_> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    let mut runs = files.iter().map(|file| versioned(file)).collect::<Result<Vec<SequenceRecord>, _>>()?;
    if runs.is_empty() {
        return Err(EvalError::NoRecords { path: folder.into() });
    }
    for run in &runs {
        unchanged(&folder.join(&run.predictions), &run.predictions_sha256)?;
    }
    runs.sort_by_key(|run| (run.elapsed != Elapsed::Measured, run.seed));
    let data = stamp(&record.data);
    Ok(Study { record, runs, data })
}

/// Returns the origin of the sequences, which have neither trials nor a licence of their own.
pub fn stamp(data: &DataRecord) -> DataStamp {
    DataStamp {
        name: "sequences".into(),
        title: data.title.clone(),
        licence: String::new(),
        source: if data.synthetic { "made by a generator".into() } else { "tables".into() },
        synthetic: data.synthetic,
        hash: data.hash.clone(),
        unit: "1".into(),
        trials: BTreeMap::new(),
        floors: None,
        constant: BTreeMap::new(),
    }
}

/// Returns the table.
pub fn tables(study: &Study) -> Vec<Table> {
    vec![table::scores(study)]
}

/// Returns the figure: name of the files, question, drawing.
pub fn figures(study: &Study) -> Vec<(&'static str, &'static str, Drawing)> {
    learning::draw(study).into_iter().map(|drawing| ("learning", learning::QUESTION, drawing)).collect()
}

impl Study {
    /// Returns the elapsed times of each row, and its runs.
    fn rows(&self) -> Vec<(&'static str, Vec<&SequenceRecord>)> {
        let row = |elapsed: Elapsed| {
            let runs: Vec<&SequenceRecord> = self.runs.iter().filter(|run| run.elapsed == elapsed).collect();
            Some((told(&runs.first()?.question.network, elapsed), runs))
        };
        ROWS.into_iter().filter_map(row).collect()
    }
}
