//! Plan of a join: files of each trial, clock offsets, and the trial's samples.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

use super::clock::align::{Alignment, Both, How, align};
use super::files;
use super::series::median;
use super::signals::{self, Axis, Signals};
use crate::checks::periodic::{self, Column, Place};
use crate::error::{DataError, Problems, short};
use crate::ingest::periodic::unwrap;
use crate::manifest::{ByTrial, Manifest, Source, Word};
use crate::toml_file::TomlSource;
use crate::units::Unit;

/// Plan of the trials of a set of several sources.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(super) folder: PathBuf,
    pub(super) sources: Vec<Source>,
    /// Index of the reference.
    pub(super) reference: usize,
    /// Columns of each source, by their names in its files.
    columns: Vec<BTreeSet<String>>,
    /// Signals of each source, as full names, in the manifest's order.
    pub(super) signals: Vec<Vec<String>>,
    /// Column of the reference whose instants are the trial's.
    pub(super) axis: String,
    /// Unit of each signal in the manifest, by its full name.
    units: BTreeMap<String, String>,
    /// Period of each angle and counter, by its full name.
    periods: BTreeMap<String, f64>,
    /// Name and files of each trial, a file for each source.
    trials: Vec<(String, Vec<PathBuf>)>,
    /// Trials that take no part.
    excluded: Vec<String>,
    /// Those of them that cannot be joined, and why.
    pub left_out: BTreeMap<String, String>,
    /// Signals of the files that hold all trials.
    shared: Vec<OnceLock<Arc<Signals>>>,
    /// Clock alignment of each trial that could be aligned.
    pub(super) aligned: Vec<Option<Vec<Alignment>>>,
    /// Recognized properties of the files.
    pub notes: Vec<String>,
    /// Signals that jump by a period.
    pub warnings: Vec<String>,
    /// Place of each source in the manifest.
    places: Vec<String>,
}

impl Plan {
    /// Finds the files of each trial in a folder; what is wrong with them goes to `problems`.
    pub fn new(manifest: &Manifest, toml: &TomlSource, folder: &Path, problems: &mut Vec<DataError>) -> Plan {
        let sources = manifest.source.list.clone();
        let reference = sources.iter().position(Source::is_reference).unwrap_or(0);
        let names: Vec<String> = manifest.signal_columns().into_iter().map(|(_, _, column, _)| column).collect();
        let signals: Vec<Vec<String>> = sources.iter().map(|s| of_source(s, &names)).collect();
        let columns = (0..sources.len()).map(|i| asked(&sources, i, reference, &signals[i])).collect();
        let outputs: Vec<String> = manifest.measured.iter().map(|m| m.column.clone()).collect();
        let first =
            of_source(&sources[reference], &outputs).into_iter().chain(signals[reference].iter().cloned()).next();
        let axis = first.and_then(|full| sources[reference].column(&full).map(str::to_string)).unwrap_or_default();
        let periods = manifest.periods();
        let units = manifest.signal_columns().into_iter().map(|(_, _, column, unit)| (column, unit)).collect();
        let places: Vec<String> =
            (0..sources.len()).map(|i| toml.place(&["source", &i.to_string(), "offset"])).collect();
        let (excluded, mut left_out, before) = (manifest.roles.excluded.clone(), BTreeMap::new(), problems.len());
        let trials = files::trials(&sources, reference, folder, &places, &excluded, &mut left_out, problems);
        if problems.len() == before {
            let known = trials.iter().map(|(name, _)| name).chain(left_out.keys()).map(String::as_str).collect();
            problems.extend(unknown_trials(&sources, toml, &known));
        }
        let (shared, aligned) = (sources.iter().map(|_| OnceLock::new()).collect(), Vec::new());
        let folder = folder.to_path_buf();
        let (notes, warnings) = (Vec::new(), Vec::new());
        Plan {
            folder,
            sources,
            reference,
            columns,
            signals,
            axis,
            units,
            periods,
            trials,
            excluded,
            left_out,
            shared,
            aligned,
            notes,
            warnings,
            places,
        }
    }

    /// How many trials there are.
    pub fn len(&self) -> usize {
        self.trials.len()
    }

    /// Name of a trial, and its file of the reference.
    pub fn trial(&self, index: usize) -> (&str, &Path) {
        let (name, files) = &self.trials[index];
        (name, &files[self.reference])
    }

    /// Clock alignment, trial by trial.
    pub fn alignments(&self) -> Vec<Alignment> {
        self.aligned.iter().flatten().flatten().cloned().collect()
    }

    /// Brings all clocks to the reference's; what is wrong goes to `problems`, and of an excluded trial to what is left out.
    pub fn align(&mut self, problems: &mut Vec<DataError>) {
        if let Err(error) = self.read_shared() {
            self.aligned = vec![None; self.len()];
            return problems.extend(error.problems());
        }
        let found: Vec<_> = (0..self.len()).into_par_iter().map(|trial| self.align_trial(trial)).collect();
        let (mut notes, mut kept) = (BTreeSet::new(), Vec::new());
        for (trial, found) in std::mem::take(&mut self.trials).into_iter().zip(found) {
            let aligned = match found {
                Ok((alignments, of_trial, warnings)) => {
                    self.warnings.extend(warnings);
                    notes.extend(of_trial);
                    Some(alignments)
                }
                Err(error) if self.excluded.contains(&trial.0) => {
                    self.left_out.insert(trial.0, error.problems().first().map_or(String::new(), DataError::to_string));
                    continue;
                }
                Err(error) => {
                    problems.extend(error.problems());
                    None
                }
            };
            self.aligned.push(aligned);
            kept.push(trial);
        }
        self.trials = kept;
        self.notes = notes.into_iter().collect();
        (0..self.sources.len()).for_each(|source| self.common(source));
    }

    /// Reads the files that hold all trials once, before the trials are read side by side.
    fn read_shared(&self) -> Result<(), DataError> {
        let Some((_, files)) = self.trials.first() else { return Ok(()) };
        let mut problems = Vec::new();
        for i in (0..self.sources.len()).filter(|i| self.sources[*i].shared) {
            match self.read_source(i, &files[i]) {
                Ok(signals) => drop(self.shared[i].set(signals)),
                Err(error) => problems.extend(error.problems()),
            }
        }
        Problems(problems).into_result()
    }

    /// How the clocks stand, notes and warnings.
    fn align_trial(&self, trial: usize) -> Result<(Vec<Alignment>, Vec<String>, Vec<String>), DataError> {
        let signals = self.read_signals(trial)?;
        let (notes, warnings) = (self.notes_of(trial, &signals), self.jumps(trial, &signals));
        let reference = &signals[self.reference];
        let start = reference.columns.get(&self.axis).and_then(|(axis, _)| reference.axes[*axis].time.first());
        let (name, mut alignments, mut problems) =
            (&self.trials[trial].0, Vec::new(), self.other_units(trial, &signals));
        for (i, source) in self.sources.iter().enumerate() {
            let (compared, same_quantity) = (self.compared(i), self.is_same_quantity(i));
            let both = Both { reference, source: &signals[i], compared, same_quantity };
            match align(name, source, &both, start.copied().unwrap_or(0.0)) {
                Ok(alignment) => alignments.push(alignment),
                Err(what) => {
                    let (at, trial, of) = (self.places[i].clone(), name.clone(), source.name.clone());
                    problems.push(DataError::Unjoined { at, trial, of, what });
                }
            }
        }
        Problems(problems).into_result().map(|()| (alignments, notes, warnings))
    }

    /// Columns that jump by a period and are not declared as periodic.
    fn jumps(&self, trial: usize, signals: &[Arc<Signals>]) -> Vec<String> {
        let (name, files) = &self.trials[trial];
        let of_source = |(i, source): (usize, &Source)| {
            let undeclared = |column: &&String| {
                let full = format!("{}.{column}", source.name);
                !self.periods.contains_key(&full) && !source.quaternions.iter().flatten().any(|part| part == *column)
            };
            let of_axis = |(axis, of): (usize, &Axis)| {
                let names = signals[i].columns.iter().filter(|(_, (own, _))| *own == axis).map(|(name, _)| name);
                let column = |name: &'_ String| {
                    let unit =
                        self.units.get(&format!("{}.{name}", source.name)).and_then(|unit| Unit::parse(unit).ok());
                    (name.clone(), unit)
                };
                let named: Vec<(String, Option<Unit>)> = names.filter(undeclared).map(column).collect();
                let values = |name: &String| signals[i].columns.get(name).map_or(&[][..], |(_, values)| values);
                let columns: Vec<Column> =
                    named.iter().map(|(name, unit)| Column { name, unit: *unit, values: values(name) }).collect();
                let (row, table) = (|i: usize| of.first_row + i, format!("[[source]] `{}`", source.name));
                periodic::warnings(&columns, &Place { file: &files[i], trial: name, table, row: &row })
            };
            signals[i].axes.iter().enumerate().flat_map(of_axis).collect::<Vec<String>>()
        };
        self.sources.iter().enumerate().flat_map(of_source).collect()
    }

    /// Columns whose file says another unit than the manifest.
    fn other_units(&self, trial: usize, signals: &[Arc<Signals>]) -> Vec<DataError> {
        let of_source = |(i, source): (usize, &Source)| {
            let path = self.folder.join(&self.trials[trial].1[i]);
            let check = |(column, written): (&String, &String)| {
                let declared = self.units.get(&format!("{}.{column}", source.name))?;
                DataError::other_unit(&path, column, Some(written), declared)
            };
            signals[i].units.iter().filter_map(check).collect::<Vec<_>>()
        };
        self.sources.iter().enumerate().flat_map(of_source).collect()
    }

    /// The columns that an estimate compares, by their names in the files.
    fn compared(&self, source: usize) -> (Vec<String>, Vec<String>) {
        let by = self.sources[source].offset.as_ref().map(|offset| offset.table().by).unwrap_or_default();
        let bare = |i: usize, full: &String| self.sources[i].column(full).unwrap_or(full).to_string();
        match by.as_slice() {
            [reference, own] => (vec![bare(self.reference, reference)], vec![bare(source, own)]),
            _ => {
                let all = |i: usize| self.signals[i].iter().map(|full| bare(i, full)).collect();
                (all(self.reference), all(source))
            }
        }
    }

    /// Whether `by` names two columns of one dimension.
    fn is_same_quantity(&self, source: usize) -> bool {
        let by = self.sources[source].offset.as_ref().map(|offset| offset.table().by).unwrap_or_default();
        let dimension = |full: &String| Some(Unit::parse(self.units.get(full)?).ok()?.dimension);
        matches!(by.as_slice(), [a, b] if dimension(a).is_some() && dimension(a) == dimension(b))
    }

    /// One offset for all trials, where the manifest asks for it: the median, with the interval of the mean of as many. A lag is the same
    /// in all of them.
    fn common(&mut self, source: usize) {
        let asked = self.sources[source].offset.as_ref().map(|offset| offset.table().estimate);
        let trials = self.trials.iter().zip(&self.aligned).filter(|((name, _), _)| !self.excluded.contains(name));
        let all: Vec<&Alignment> = trials.filter_map(|(_, aligned)| Some(&aligned.as_ref()?[source])).collect();
        if asked != Some(Some(Word::Common)) || all.is_empty() {
            return;
        }
        let of = |part: &dyn Fn(&Alignment) -> f64| all.iter().map(|one| part(one)).collect::<Vec<f64>>();
        let (count, middle) = (all.len(), median(&of(&|one| one.offset)));
        let (lag, largest) = (median(&of(&Alignment::seen_lag)), median(&of(&|one| one.lag.0)));
        let own = median(&of(&|one| one.interval - one.seen_lag()));
        let spread = 1.96 * 1.4826 * median(&of(&|one| (one.offset - middle).abs()));
        let interval = spread.max(own) / (count as f64).sqrt() + lag;
        for trial in self.aligned.iter_mut().flatten() {
            let alignment = &mut trial[source];
            (alignment.offset, alignment.interval, alignment.how) = (middle, interval, How::Common(count));
            alignment.lag = (largest, lag > 0.0);
        }
    }

    /// Signals of each source's file of a trial.
    pub(super) fn read_signals(&self, trial: usize) -> Result<Vec<Arc<Signals>>, DataError> {
        let (mut all, mut problems) = (Vec::new(), Vec::new());
        for (i, file) in self.trials[trial].1.iter().enumerate() {
            match self.shared[i].get().cloned().map_or_else(|| self.read_source(i, file), Ok) {
                Ok(signals) => all.push(signals),
                Err(error) => problems.extend(error.problems()),
            }
        }
        Problems(problems).into_result().map(|()| all)
    }

    fn read_source(&self, i: usize, file: &Path) -> Result<Arc<Signals>, DataError> {
        let signals = signals::read(&self.folder.join(file), &self.sources[i], &self.columns[i])?;
        Ok(Arc::new(self.unwrapped(&self.sources[i], signals)))
    }

    fn unwrapped(&self, source: &Source, mut signals: Signals) -> Signals {
        for (column, (_, values)) in &mut signals.columns {
            let period = self.periods.get(&format!("{}.{column}", source.name));
            period.into_iter().for_each(|period| unwrap(values, *period));
        }
        signals
    }

    fn notes_of(&self, trial: usize, signals: &[Arc<Signals>]) -> Vec<String> {
        let of = |(i, signals): (usize, &Arc<Signals>)| {
            let (source, file) = (&self.sources[i].name, self.trials[trial].1[i].display().to_string());
            let format = signals.format.map_or("", crate::formats::Format::name);
            let mut notes = vec![format!("source `{source}` is read as {format}")];
            notes.extend(signals.notes.iter().map(|note| match note.strip_prefix("LOST: ") {
                Some(lost) => format!("{file}: {lost}"),
                None => format!("source `{source}`: {note}"),
            }));
            notes
        };
        signals.iter().enumerate().flat_map(of).collect()
    }

    /// A trial's columns and how its clocks stand; none where they could not be brought together.
    pub(super) fn aligned_signals(&self, trial: &str) -> Result<Option<(Vec<Arc<Signals>>, &[Alignment])>, DataError> {
        let index = self.trials.iter().position(|(name, _)| name == trial);
        let aligned = index.and_then(|index| Some((index, self.aligned.get(index)?.as_ref()?)));
        aligned.map(|(index, aligned)| Ok((self.read_signals(index)?, aligned.as_slice()))).transpose()
    }

    /// Unit of a signal in the manifest, by its full name.
    pub(super) fn unit(&self, name: &str) -> Option<String> {
        self.units.get(name).cloned()
    }
}

/// Trials that an offset names and the files do not have.
fn unknown_trials(sources: &[Source], toml: &TomlSource, known: &BTreeSet<&str>) -> Vec<DataError> {
    let mut problems = Vec::new();
    let names = short(&known.iter().copied().collect::<Vec<_>>().join(" "), 400);
    for (i, source) in sources.iter().enumerate() {
        let Some(offset) = source.offset.as_ref().map(crate::manifest::Offset::table) else { continue };
        for (key, numbers) in [("value", &offset.value), ("around", &offset.around)] {
            let named = numbers.iter().flat_map(ByTrial::numbers).filter_map(|(trial, _)| trial);
            for trial in named.filter(|trial| !known.contains(trial)) {
                let at = toml.place(&["source", &i.to_string(), "offset", key, trial]);
                let (section, trial, known) = ("[[source]] offset", trial.to_string(), names.clone());
                problems.push(DataError::UnknownTrial { at, section, trial, known });
            }
        }
    }
    problems
}

/// The names that are columns of a source.
fn of_source(source: &Source, names: &[String]) -> Vec<String> {
    names.iter().filter(|name| source.column(name).is_some()).cloned().collect()
}

/// Columns to read of a source's files: signals, and what clocks and rotations need.
fn asked(sources: &[Source], i: usize, reference: usize, signals: &[String]) -> BTreeSet<String> {
    let bare = |name: &String| sources[i].column(name).unwrap_or(name).to_string();
    let mut columns: BTreeSet<String> = signals.iter().map(bare).collect();
    columns.extend(sources[i].quaternions.iter().flatten().cloned());
    for (k, other) in sources.iter().enumerate() {
        let Some(offset) = other.offset.as_ref().map(crate::manifest::Offset::table) else { continue };
        if i == reference {
            columns.extend(offset.reference.as_ref().map(bare));
            columns.extend(offset.by.first().map(bare));
        }
        if i == k {
            columns.extend(offset.event.as_ref().map(bare));
            columns.extend(offset.by.get(1).map(bare));
        }
    }
    columns
}
