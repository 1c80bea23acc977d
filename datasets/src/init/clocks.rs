//! Pairs of columns of two sources that move together, for the alignment of their clocks; found in the first trial.

use std::collections::BTreeSet;
use std::path::Path;

use super::found::Found;
use super::names::quoted;
use super::signals::{Part, Signal};
use crate::join::clock::estimate::Named;
use crate::join::{self, Request, Series, estimate};
use crate::manifest::{Source, Time};

/// Columns of a source that are compared with each output.
const COMPARED: usize = 20;

/// The columns by which the clock of a source can be estimated, and what is found in the first trial; `None` if nothing moves
/// together. Columns that are named as measurements are compared first.
pub(super) fn located(
    folder: &Path,
    reference: &Found,
    source: &Found,
    signals: &[Signal],
) -> Option<([String; 2], String)> {
    let first = reference.files.iter().find(|file| source.file(reference.trial(file)).is_some())?;
    let trial = reference.trial(first);
    let outputs: Vec<&Signal> = signals.iter().filter(|signal| signal.part == Part::Measured).collect();
    let is_own = |signal: &&Signal| std::ptr::eq(signal.source, source) && signal.flaw.is_none();
    let mut columns: Vec<&Signal> = signals.iter().filter(is_own).collect();
    columns.sort_by_key(|signal| signal.named() != Part::Measured);
    columns.truncate(COMPARED);
    let outputs = series(&folder.join(&first.path), reference, &outputs)?;
    let columns = series(&folder.join(&source.file(trial)?.path), source, &columns)?;
    let request = Request { drift: Some(0.0), ..Request::default() };
    let found = estimate(&named(&outputs), &named(&columns), &request).ok()?;
    Some((
        [format!("{}.{}", reference.name, found.reference), format!("{}.{}", source.name, found.source)],
        format!("correlation {:.2} in trial {}, t {:+.3} s", found.correlation, quoted(trial), found.offset),
    ))
}

fn named(all: &[(String, Series)]) -> Vec<Named<'_>> {
    all.iter().map(|(name, series)| (name.as_str(), series)).collect()
}

/// Some columns of a file, as the manifest would read them.
fn series(path: &Path, of: &Found, signals: &[&Signal]) -> Option<Vec<(String, Series)>> {
    let (column, unit) = of.time.as_ref().map(|time| (time.column.clone(), time.unit.clone())).unzip();
    let time = Time { column, unit: unit.flatten(), rate_hz: None };
    let source = Source { name: of.name.clone(), format: Some(of.format), time, ..Source::default() };
    let columns: BTreeSet<String> = signals.iter().map(|signal| signal.of.name.to_string()).collect();
    let read = join::signals::read(path, &source, &columns).ok()?;
    Some(columns.into_iter().filter_map(|name| Some((name.clone(), read.series(&name)?))).collect())
}
