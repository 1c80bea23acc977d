//! Check that a record and its prediction table belong together.

use std::path::Path;

use acm_train::run::record::RunRecord;

use crate::error::EvalError;
use crate::run::predictions::{HELD_OUT, Predictions, VALIDATION};

/// Checks that every score has one error and one R² per output.
///
/// # Errors
/// One has not: the record is named.
pub fn complete(record: &RunRecord, folder: &Path) -> Result<(), EvalError> {
    let parts = [Some(&record.validation), record.held_out.as_ref()].into_iter().flatten();
    let all = parts.flat_map(|part| std::iter::once(&part.estimators).chain(part.trials.values())).flatten();
    let outputs = record.outputs.len();
    for (estimator, score) in all {
        if score.rmse.len() != outputs || score.r2.len() != outputs {
            let file = folder.join("records").join(format!("{}.json", record.id));
            let (rmse, r2) = (score.rmse.len(), score.r2.len());
            let reason = format!("{estimator} has {rmse} errors and {r2} values of R² for {outputs} outputs");
            return Err(EvalError::Record { file, reason });
        }
    }
    Ok(())
}

/// Largest relative difference between an error in a record and the same error computed from its table.
const AGREEMENT: f64 = 1e-6;

/// Computes each 3-D error again.
///
/// # Errors
/// A table that was swapped or cut gives other errors than its record, and is named.
pub fn agrees(record: &RunRecord, table: &Predictions, path: &Path) -> Result<(), EvalError> {
    let parts = [(VALIDATION, Some(&record.validation)), (HELD_OUT, record.held_out.as_ref())];
    for (part, scores) in parts.into_iter().filter_map(|(part, scores)| Some((part, scores?))) {
        let rows: Vec<usize> = table.trials(part).into_iter().flat_map(|trial| trial.rows).collect();
        for (key, score) in &scores.estimators {
            let estimate = if matches!(key.as_str(), "nominal" | "polynomial") { key } else { "predicted" };
            let squares: f64 = rows.iter().map(|&row| table.distance(estimate, &record.outputs, row).powi(2)).sum();
            let rmse = (squares / rows.len() as f64).sqrt();
            if rows.len() != score.samples || !((rmse - score.rmse_total).abs() <= AGREEMENT * rmse.max(1e-9)) {
                let reason = format!(
                    "its {part} rows give {rmse:.6} {unit} over {} time stamps for {key}, and record {} says {:.6} \
                     {unit} over {}: they do not belong together",
                    rows.len(),
                    record.id,
                    score.rmse_total,
                    score.samples,
                    unit = record.data.unit,
                );
                return Err(EvalError::Predictions { path: path.into(), reason });
            }
        }
    }
    Ok(())
}
