//! Pairs of columns of two sources that move together, for the alignment of their clocks; found in the first trial.

use std::collections::BTreeSet;
use std::path::Path;

use super::column::Column;
use super::found::Found;
use super::names::quoted;
use super::time;
use crate::join::clock::estimate::Named;
use crate::join::{Request, Series, estimate, signals};
use crate::manifest::{Source, Time};

/// Columns of a source that are compared with each output of the reference.
const COMPARED: usize = 20;

/// Parts of names of columns that tell of a motion.
const MOTION: &[&str] =
    &["position", "pose", "odom", "attitude", "angle", "joint", "encoder", "motor", ".x", ".y", ".z", "q[", "q1", "q2"];

/// Two columns of one motion.
pub(super) struct Located {
    /// Columns of the reference and of the source, with the sources' names before them.
    pub by: [String; 2],
    /// Their correlation, and the offset in the first trial.
    pub found: String,
}

/// The columns by which the clock of a source can be estimated; `None` if nothing moves together.
pub(super) fn located(folder: &Path, reference: &Found, outputs: &[String], source: &Found) -> Option<Located> {
    let first = reference.files.iter().find(|file| source.file(reference.trial(file)).is_some())?;
    let trial = reference.trial(first);
    let of_reference = series(&folder.join(&first.path), reference, outputs.iter().cloned())?;
    let of_source = series(&folder.join(&source.file(trial)?.path), source, candidates(source).into_iter())?;
    let r: Vec<Named> = of_reference.iter().map(|(name, series)| (name.as_str(), series)).collect();
    let s: Vec<Named> = of_source.iter().map(|(name, series)| (name.as_str(), series)).collect();
    let found = estimate(&r, &s, &Request { drift: Some(0.0), ..Request::default() }).ok()?;
    Some(Located {
        by: [format!("{}.{}", reference.name, found.reference), format!("{}.{}", source.name, found.source)],
        found: format!("correlation {:.2} in trial {}, t {:+.3} s", found.correlation, quoted(trial), found.offset),
    })
}

/// Columns that tell of a motion, or the first.
fn candidates(source: &Found) -> Vec<String> {
    let time = time::of(source, None).map(|time| time.column);
    let columns = source.columns();
    let usable = |column: &&Column| column.flaw().is_none() && Some(column.name) != time.as_deref();
    let names = || columns.iter().filter(usable).map(|column| column.name).filter(|name| !name.contains("timestamp"));
    let moves = |name: &&str| MOTION.iter().any(|part| name.to_lowercase().contains(part));
    let moving: Vec<String> = names().filter(moves).take(COMPARED).map(str::to_string).collect();
    if moving.is_empty() { names().take(COMPARED).map(str::to_string).collect() } else { moving }
}

fn series(path: &Path, of: &Found, columns: impl Iterator<Item = String>) -> Option<Vec<(String, Series)>> {
    let time = time::of(of, None).filter(|_| of.format.is_table());
    let column = time.map(|time| Time { column: Some(time.column), unit: time.unit, rate_hz: None });
    let time = column.unwrap_or_default();
    let source = Source { name: of.name.clone(), format: Some(of.format), time, ..Source::default() };
    let columns: BTreeSet<String> = columns.collect();
    let read = signals::read(path, &source, &columns).ok()?;
    Some(columns.into_iter().filter_map(|name| Some((name.clone(), read.series(&name)?))).collect())
}
