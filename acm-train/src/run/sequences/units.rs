//! Errors of a run by sequence, the exchangeable unit where windows of one sequence are not.
//!
//! ```text
//! numbers   e_s = Σ (p − t)² / n_s          over all outputs and steps of sequence s, in the square of the targets' unit
//! labels    e_s = mean cross-entropy
//! ```

use std::{collections::BTreeMap, path::Path};

use acm_datasets::files::table::{Column, read_parquet};
use acm_datasets::sequences::table::whole;

use super::record::SequenceRecord;
use crate::{config::Loss, run::error::RunError};

/// Returns the mean error of each sequence of the part that was scored, by name; windows count to the sequence that
/// they are of.
///
/// # Errors
/// The table of predictions cannot be read.
pub fn errors(root: &Path, record: &SequenceRecord) -> Result<BTreeMap<String, f64>, RunError> {
    let table = read_parquet(&root.join(&record.predictions))?;
    let part = if record.test.is_some() { "test" } else { "validation" };
    Ok(of(&table, part, record.question.loss))
}

/// Returns the error of each sequence. The columns are `part`, `sequence`, `step`, then a target and its prediction,
/// output after output.
fn of(table: &[(String, Column)], part: &str, loss: Loss) -> BTreeMap<String, f64> {
    let text = |name: &str| table.iter().find(|(known, _)| known == name).and_then(|(_, column)| column.text());
    let (Some(parts), Some(names)) = (text("part"), text("sequence")) else { return BTreeMap::new() };
    let numbers: Vec<&[f64]> = table.iter().skip(3).filter_map(|(_, column)| column.numbers()).collect();
    let mut sums: BTreeMap<&str, (f64, usize)> = BTreeMap::new();
    for row in (0..names.len()).filter(|&row| parts[row] == part) {
        let (sum, count) = sums.entry(whole(&names[row])).or_default();
        for pair in numbers.chunks_exact(2) {
            *sum += error(loss, pair[0][row], pair[1][row]);
            *count += 1;
        }
    }
    sums.into_iter().map(|(name, (sum, count))| (name.to_string(), sum / count as f64)).collect()
}

/// Returns the squared error of a number, in the square of its unit; the cross-entropy of a label, in nats.
pub fn error(loss: Loss, target: f64, said: f64) -> f64 {
    match loss {
        Loss::MeanSquare => (said - target).powi(2),
        Loss::CrossEntropy => said.max(0.0) - said * target + (-said.abs()).exp().ln_1p(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Two windows of `a` with errors 1, 2 and 3, 4 over two outputs; `b` is of another part.
    #[test]
    fn windows_count_to_their_sequence() {
        let texts = |values: &[&str]| Column::Text(values.iter().map(ToString::to_string).collect());
        let table = [
            ("part", texts(&["validation", "validation", "test"])),
            ("sequence", texts(&["a from step 1", "a from step 17", "b"])),
            ("step", Column::Number(vec![1.0; 3])),
            ("target_x", Column::Number(vec![0.0, 1.0, 0.0])),
            ("predicted_x", Column::Number(vec![1.0, 4.0, 9.0])),
            ("target_y", Column::Number(vec![0.0, 0.0, 0.0])),
            ("predicted_y", Column::Number(vec![2.0, 4.0, 9.0])),
        ]
        .map(|(name, column)| (name.to_string(), column));
        let found = of(&table, "validation", Loss::MeanSquare);
        assert_eq!(found, BTreeMap::from([("a".to_string(), (1.0 + 4.0 + 9.0 + 16.0) / 4.0)]));
        assert!((error(Loss::CrossEntropy, 1.0, 0.0) - 2f64.ln()).abs() < 1e-15);
    }
}
