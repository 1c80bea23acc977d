//! Intervals about the predictions of an experiment: `intervals.json`, beside its records.
//!
//! The half-widths come from the validation parts, which no run was fitted to, and are compared with the held-out trials
//! ([`conformal`](crate::learn::conformal)). What counts as one is the first of these of which two or more were left out:
//!
//! | unit          | where                                                                                    |
//! | ------------- | ---------------------------------------------------------------------------------------- |
//! | value         | folds leave out one value of a signal at a time: trials of one value are alike           |
//! | trial         | others; a block of a trial where folds leave out blocks                                  |
//! | block of time | one trial was left out: a ninth of it, since nine units attain 90 %                      |
//!
//! A run's own validation part chose its epoch and factor, two numbers, and counts as left out.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use acm_core::display::{DIGITS, Display, significant};
use acm_datasets::DataError;
use acm_datasets::files::table::{Column, read_parquet};
use acm_datasets::text::terminal::{MOST_ACROSS, ruled, turned};
use serde::{Deserialize, Serialize};

use super::summary::{self, in_unit};
use crate::run::record::{RunRecord, Stage};
use crate::{
    learn::conformal::{attainable, half_width, share},
    store::{StoreError, hashed},
};

/// Requested level of an interval, where there are enough units.
pub const WANTED: f64 = 0.9;

/// Names of a trial, and of a block of the only one.
const TRIAL: &str = "trial";
const BLOCK: &str = "block of time";

/// The part of a table that was left out of training.
const VALIDATION: &str = "validation";

/// Name of the file.
pub const FILE: &str = "intervals.json";

/// The number in [`Intervals::format`].
pub const FORMAT: u32 = 1;

/// Number of blocks of the only trial that was left out.
const BLOCKS: usize = 9;

/// Exchangeable unit.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Unit {
    Value(String),
    Trial,
    Block,
}

/// The intervals of an experiment's final runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Intervals {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Requested level, a share of 1.
    pub wanted: f64,
    /// Level that the number of units allows, at most `wanted`.
    pub level: f64,
    /// Exchangeable unit: `trial`, `block of time`, or the name of a signal of which one value is left out at a time.
    pub unit: String,
    /// Number of units that were left out in turn.
    pub units: usize,
    /// Intervals, one for each output.
    pub outputs: Vec<Interval>,
}

/// The interval of one output: prediction ± half-width.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Name of the output.
    pub output: String,
    /// Half-width, SI.
    pub half_width: f64,
    /// Share of the units left out that the interval covers, each by the half-width of the others.
    pub left_out: f64,
    /// Share of the held-out samples that the interval covers, over all seeds; none without held-out trials.
    pub held_out: Option<f64>,
}

/// Absolute errors of an output: of each unit, and of the held-out samples.
#[derive(Debug, Default)]
struct Errors {
    units: BTreeMap<String, Vec<f64>>,
    held_out: Vec<f64>,
}

/// Returns the intervals from the records in the folder `run` and their tables of predictions; none without a final
/// run.
///
/// # Errors
/// A table cannot be read.
pub fn of(records: &[&RunRecord], run: &Path) -> Result<Option<Intervals>, DataError> {
    let Some(last) = records.iter().find(|record| record.stage == Stage::Final) else { return Ok(None) };
    let mut errors: Vec<Errors> = last.outputs.iter().map(|_| Errors::default()).collect();
    let unit = Unit::of(records, last);
    for record in records {
        collect(record, &unit, &run.join(&record.predictions), &mut errors)?;
    }
    Ok(settle(&last.outputs, unit, errors))
}

/// What a model predicts of some targets, beside the measured values, target by target [T·O], SI.
#[derive(Debug)]
pub struct Predicted<'a> {
    /// Trial of each target.
    pub trial: &'a [String],
    /// Measured outputs.
    pub measured: &'a [f64],
    /// Predicted outputs.
    pub predicted: Vec<f64>,
}

/// Returns the intervals of a model without a run folder of its own, such as an average of several: from what it predicts of
/// each fold that it did not learn from, and of the held-out trials. `value_of` names the signal of which folds leave out one
/// value at a time.
pub fn of_folds(
    outputs: &[String],
    value_of: Option<&String>,
    folds: &[Predicted],
    held_out: &Predicted,
) -> Option<Intervals> {
    let trials: BTreeSet<&String> = folds.iter().flat_map(|fold| fold.trial).collect();
    let unit = Unit::with(value_of, folds.len(), trials.len());
    let mut errors: Vec<Errors> = outputs.iter().map(|_| Errors::default()).collect();
    for (o, errors) in errors.iter_mut().enumerate() {
        let of = |told: &Predicted| -> Vec<f64> {
            let pairs = told.measured.iter().zip(&told.predicted).skip(o).step_by(outputs.len());
            pairs.map(|(measured, predicted)| (measured - predicted).abs()).collect()
        };
        errors.held_out = of(held_out);
        for (fold, told) in folds.iter().enumerate() {
            for (place, error) in of(told).into_iter().enumerate() {
                let name = match unit {
                    Unit::Value(_) => fold.to_string(),
                    Unit::Trial => told.trial[place].clone(),
                    Unit::Block => (place * BLOCKS / told.trial.len()).to_string(),
                };
                errors.units.entry(name).or_default().push(error);
            }
        }
    }
    settle(outputs, unit, errors)
}

/// Returns the intervals from the errors of each output.
fn settle(outputs: &[String], unit: Unit, errors: Vec<Errors>) -> Option<Intervals> {
    let units = errors.first().map_or(0, |errors| errors.units.len());
    let level = attainable(WANTED, units);
    let one = |(output, errors): (&String, Errors)| {
        let found = half_width(&errors.units.into_values().collect::<Vec<_>>(), level)?;
        let mut held_out = errors.held_out;
        held_out.sort_by(f64::total_cmp);
        Some(Interval {
            output: output.clone(),
            half_width: found.half_width,
            left_out: found.left_out,
            held_out: (!held_out.is_empty()).then(|| share(&held_out, found.half_width)),
        })
    };
    let outputs = outputs.iter().zip(errors).map(one).collect::<Option<Vec<Interval>>>();
    let unit = match unit {
        Unit::Value(signal) => signal,
        Unit::Trial => TRIAL.into(),
        Unit::Block => BLOCK.into(),
    };
    outputs.map(|outputs| Intervals { format: FORMAT, wanted: WANTED, level, unit, units, outputs })
}

/// Reads the intervals of the folder `run`; none without final runs, or in folders of earlier versions.
///
/// # Errors
/// The file cannot be read, or was changed.
pub fn read(run: &Path) -> Result<Option<Intervals>, StoreError> {
    let path = run.join(FILE);
    path.is_file().then(|| hashed::read(&path, FORMAT)).transpose()
}

impl Unit {
    fn of(records: &[&RunRecord], last: &RunRecord) -> Self {
        let folds: BTreeSet<usize> = records.iter().filter_map(|record| Some(record.folds.as_ref()?.fold)).collect();
        let trials: BTreeSet<&String> = records.iter().flat_map(|record| &record.split.validation).collect();
        Self::with(last.folds.as_ref().and_then(|folds| folds.value_of.as_ref()), folds.len(), trials.len())
    }

    /// Returns the unit where so many folds leave out so many trials.
    fn with(value_of: Option<&String>, folds: usize, trials: usize) -> Self {
        match value_of {
            Some(signal) if folds > 1 => Self::Value(signal.clone()),
            _ if trials > 1 => Self::Trial,
            _ => Self::Block,
        }
    }
}

/// Adds what one run predicted of trials that it was not fitted to.
fn collect(record: &RunRecord, unit: &Unit, path: &Path, errors: &mut [Errors]) -> Result<(), DataError> {
    let columns: BTreeMap<String, Column> = read_parquet(path)?.into_iter().collect();
    let damaged = |name: &str| DataError::Damaged { path: path.into(), reason: format!("there is no column `{name}`") };
    let text = |name: &str| columns.get(name).and_then(Column::text).ok_or_else(|| damaged(name));
    let numbers = |name: String| columns.get(&name).and_then(Column::numbers).ok_or_else(|| damaged(&name));
    let (trials, parts) = (text("trial")?, text("part")?);
    let fold = record.folds.as_ref().map_or(0, |folds| folds.fold).to_string();
    let validated = parts.iter().filter(|part| *part == VALIDATION).count();
    let blocks: Vec<String> = (0..BLOCKS).map(|block| block.to_string()).collect();
    for (output, errors) in record.outputs.iter().zip(errors) {
        let (measured, predicted) = (numbers(format!("measured_{output}"))?, numbers(format!("predicted_{output}"))?);
        let mut place = 0;
        for (row, (m, p)) in measured.iter().zip(predicted).enumerate() {
            match parts[row].as_str() {
                VALIDATION => {
                    let unit = match unit {
                        Unit::Value(_) => &fold,
                        Unit::Trial => &trials[row],
                        Unit::Block => &blocks[place * BLOCKS / validated],
                    };
                    place += 1;
                    match errors.units.get_mut(unit) {
                        Some(known) => known.push((m - p).abs()),
                        None => drop(errors.units.insert(unit.clone(), vec![(m - p).abs()])),
                    }
                }
                _ => errors.held_out.push((m - p).abs()),
            }
        }
    }
    Ok(())
}

impl Intervals {
    /// Returns the level and units in words: `90 % intervals, from 12 trials left out in turn`.
    pub fn title(&self) -> String {
        let (level, units) = (percent(self.level), self.units);
        let unit = match self.unit.as_str() {
            TRIAL => "trials".into(),
            BLOCK => "blocks of time".into(),
            signal => format!("values of {signal}"),
        };
        let most =
            if self.level < self.wanted { format!(" ({level} is the most that so few attain)") } else { String::new() };
        format!("{level} intervals, from {units} {unit} left out in turn{most}")
    }

    /// Writes half-widths and coverage of each output, as a table with a title; `records` determine the unit.
    pub fn text(&self, records: &[&RunRecord]) -> String {
        let Some(first) = records.first() else { return String::new() };
        self.shown(&summary::display(&first.data.unit, records.iter().map(|record| &record.validation)))
    }

    /// Writes the same in the unit of a display.
    pub fn shown(&self, display: &Display) -> String {
        let row = |name: &str, cell: &dyn Fn(&Interval) -> String| {
            std::iter::once(name.to_string()).chain(self.outputs.iter().map(cell)).collect::<Vec<_>>()
        };
        let mut rows = vec![
            row("half-width", &|of| format!("± {}", significant(of.half_width * display.factor, DIGITS))),
            row("units left out that it holds", &|of| percent(of.left_out)),
        ];
        if self.outputs.iter().any(|of| of.held_out.is_some()) {
            rows.push(row("held-out samples that it holds", &|of| of.held_out.map_or(String::new(), percent)));
        }
        let header = std::iter::once(String::new()).chain(self.outputs.iter().map(|of| of.output.clone())).collect();
        let (header, rows) = if self.outputs.len() > MOST_ACROSS { turned(header, &rows) } else { (header, rows) };
        format!("{}: prediction ± half-width{}\n{}", self.title(), in_unit(display), ruled(header, rows, 1))
    }
}

/// Writes a share as `88 %`.
pub fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}
