//! Mean prediction over the seeds of a row, from their tables of predictions.
//!
//! ```text
//! p = Σ_m p_m / M          of labels: the mean logit
//! ```

use std::path::Path;

use acm_datasets::files::table::read_parquet;
use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use super::{
    record::SequenceRecord,
    scores::{Scores, scores, targets},
    table::{ROWS, Together},
    train::answer,
};
use crate::{learn::ensemble, run::error::RunError};

/// Scores the mean prediction of each row with at least two runs.
///
/// # Errors
/// A table of predictions cannot be read.
pub fn together(root: &Path, set: &SequenceSet, records: &[SequenceRecord]) -> Result<Vec<Together>, RunError> {
    let mut all = vec![];
    for elapsed in ROWS {
        let row: Vec<&SequenceRecord> = records.iter().filter(|record| record.elapsed == elapsed).collect();
        if row.len() < 2 {
            continue;
        }
        let tested = row.iter().all(|record| record.test.is_some());
        let tables = row.iter().map(|record| predicted(&root.join(&record.predictions), set, record));
        let mean = ensemble::mean(tables.collect::<Result<Vec<_>, _>>()?);
        let first: usize = set.validation.iter().map(|one| one.targets.nrows()).sum();
        let score = |sequences: &[Sequence], rows: std::ops::Range<usize>| -> Scores {
            let predicted = mean.rows(rows.start, rows.len()).into_owned();
            scores(sequences.len(), &predicted, &targets(sequences), row[0].question.loss)
        };
        let validation = score(&set.validation, 0..first);
        let scored = if tested { score(&set.test, first..mean.nrows()) } else { validation.clone() };
        all.push(Together { elapsed, runs: row.len(), validation, scored });
    }
    Ok(all)
}

/// Returns the predictions of a run for the validation part, then for the test part [N×O].
///
/// # Errors
/// The table of predictions cannot be read, or is of other sequences.
pub fn predicted(file: &Path, set: &SequenceSet, record: &SequenceRecord) -> Result<DMatrix<f64>, RunError> {
    let test = if record.test.is_some() { &*set.test } else { &[] };
    let table = read_parquet(file)?;
    let column = |output: &String| {
        let name = answer(record.question.loss, &set.outputs, output);
        table.iter().find(|(known, _)| *known == name).and_then(|(_, column)| column.numbers())
    };
    let columns: Vec<&[f64]> = set.outputs.iter().filter_map(column).collect();
    let rows: usize = set.validation.iter().chain(test).map(|one| one.targets.nrows()).sum();
    if columns.len() != set.outputs.len() || columns.iter().any(|column| column.len() != rows) {
        return Err(RunError::Unusable {
            what: format!("{} is not the table of predictions of these sequences", file.display()),
            help: "start again with --out DIR".into(),
        });
    }
    Ok(DMatrix::from_fn(rows, columns.len(), |row, o| columns[o][row]))
}
