//! Joined trials as a data set of plain tables.

use std::path::Path;

use super::clock::align::How;
use crate::error::DataError;
use crate::files::atomic;
use crate::files::table::{Column, write_parquet};
use crate::ingest::layout::JOINED_TIME;
use crate::ingest::recording::Recording;
use crate::manifest::{Manifest, Sources, Table, Time, written};
use crate::recordings::Recordings;

/// First line of the manifest.
const HEAD: &str = "# Written by acm-data join";

/// Writes a table for each trial, a manifest for them, and `clocks.txt`: how the clocks stand. The files' names with their
/// numbers of rows.
///
/// Columns and units are those of the manifest; samples that lack a column are left out.
///
/// # Errors
/// A set that has one source; the file system; a trial of which nothing is left.
pub fn write(data: &Recordings, out: &Path) -> Result<Vec<(String, usize)>, DataError> {
    if data.manifest.source.list.is_empty() {
        let message = format!("{}: the manifest has no [[source]], so there is nothing to join", data.manifest.name);
        return Err(DataError::Usage(message));
    }
    written::claim(out, HEAD)?;
    std::fs::create_dir_all(out).map_err(|e| DataError::file_system("create", out, &e))?;
    let mut written = Vec::new();
    for joined in data.joined() {
        let (trial, recording) = joined?;
        let columns = columns(&recording);
        let rows = columns.first().and_then(|(_, column)| column.numbers().map(<[f64]>::len)).unwrap_or_default();
        if rows == 0 {
            return Err(DataError::NoRows { path: recording.path });
        }
        let name = format!("{trial}.parquet");
        write_parquet(&out.join(&name), &columns)?;
        written.push((name, rows));
    }
    written::write(&manifest(&data.manifest), out, HEAD)?;
    atomic::write_bytes(&out.join("clocks.txt"), clocks(data).as_bytes())?;
    Ok(written)
}

/// Time first, then the columns by name; the samples that have all of them.
fn columns(recording: &Recording) -> Vec<(String, Column)> {
    let whole = |k: &usize| recording.numbers.values().all(|values| values[*k].is_finite());
    let kept: Vec<usize> = (0..recording.rows).filter(whole).collect();
    let column = |(name, values): (&String, &Vec<f64>)| {
        (name.clone(), Column::Number(kept.iter().map(|k| values[*k]).collect()))
    };
    let (time, others): (Vec<_>, Vec<_>) = recording.numbers.iter().partition(|(name, _)| *name == JOINED_TIME);
    time.into_iter().chain(others).map(column).collect()
}

/// Manifest with the same signals and roles, and tables with a column of time.
fn manifest(of: &Manifest) -> Manifest {
    let time = Time { column: Some(JOINED_TIME.to_string()), unit: Some("s".into()), rate_hz: None };
    let table = Table { files: vec!["*.parquet".into()], time, ..Table::default() };
    let source = Sources { text: of.provenance.clone(), list: Vec::new() };
    Manifest { table, source, provenance: String::new(), ..of.clone() }
}

fn clocks(data: &Recordings) -> String {
    let notes = data.notes.iter().map(|note| format!("{note}\n"));
    let moved = data.alignments.iter().filter(|alignment| alignment.how != How::Same);
    notes.chain(moved.map(|alignment| format!("trial `{}` · {alignment}\n", alignment.trial))).collect()
}
