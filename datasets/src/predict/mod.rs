//! A nominal model of one's own: recordings with its predictions, as a data set of a plain table.
//!
//! ```text
//! trials ─ given ─▶ model: a program (program), or any function ─ [T×M] ─▶ columns predicted_… of a new data set (set)
//! ```
//!
//! The model takes and answers values in the units of the manifest, a trial at a time. What it said is data from then on: it is hashed with
//! the recordings, and reading them runs no program.

mod given;
mod program;
mod set;

use std::borrow::Cow;
use std::path::Path;

use nalgebra::DMatrix;

pub use given::Given;
pub use program::Program;
pub use set::TABLE;

use crate::error::DataError;
use crate::files::table::write_parquet_groups;
use crate::manifest::{Manifest, written};
use crate::trial::Trial;
use crate::units::Unit;

/// First line of the manifest.
const HEAD: &str = "# Written by acm-data predict";

/// Writes the trials with what `model` predicts of them, and a manifest for them; the number of samples. `by` names the model.
///
/// `model` gives [T×M] in the units of the outputs.
///
/// # Errors
/// A model that fails or answers no such numbers; a folder with another data set; the file system.
pub fn write<'a>(
    manifest: &Manifest,
    trials: impl Iterator<Item = Result<Cow<'a, Trial>, DataError>>,
    out: &Path,
    by: &str,
    mut model: impl FnMut(&Given) -> Result<DMatrix<f64>, DataError>,
) -> Result<usize, DataError> {
    written::claim(out, HEAD)?;
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))?;
    let units: Vec<Unit> = manifest.measured.iter().filter_map(|output| Unit::parse(&output.unit).ok()).collect();
    let (mut known, mut samples) = (Vec::new(), 0);
    let groups = trials.map(|trial| {
        let trial = trial?;
        // a model may remember the inputs of samples without an output
        let (whole, _) = trial.with_unmeasured();
        let predicted = in_si(model(&Given::of(manifest, &whole))?, &whole, &units)?;
        samples += whole.samples();
        known.push(trial.select(&[]));
        Ok(set::columns(manifest, &whole, &predicted))
    });
    write_parquet_groups(&out.join(TABLE), groups)?;
    written::write(&set::manifest(manifest, &known, by), out, HEAD)?;
    Ok(samples)
}

/// Numbers in the outputs' units as SI, once they are as many as they should be, and finite.
fn in_si(answer: DMatrix<f64>, trial: &Trial, units: &[Unit]) -> Result<DMatrix<f64>, DataError> {
    let refused = |what: String, remedy| DataError::Model { trial: trial.name.clone(), what, remedy };
    let (rows, columns) = (trial.samples(), trial.measured.ncols());
    if answer.shape() != (rows, columns) {
        let (own, other) = answer.shape();
        let what = format!("gave {own}×{other} numbers for {rows} samples of {columns} outputs");
        return Err(refused(what, "give a row a sample and a column an output"));
    }
    if let Some((row, value)) = answer.row_iter().enumerate().find_map(|(t, row)| {
        let value = row.iter().copied().find(|value| !value.is_finite())?;
        Some((t, value))
    }) {
        let what = format!("predicts {value} at sample {} (time {} s)", row + 1, trial.time[row]);
        return Err(refused(what, "give finite numbers for every sample, or exclude the trial"));
    }
    Ok(DMatrix::from_fn(rows, columns, |t, o| units[o].to_si(answer[(t, o)])))
}
