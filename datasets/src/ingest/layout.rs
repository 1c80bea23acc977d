//! The manifest's signals as lists of columns with their units.

use std::collections::BTreeMap;

use regex::Regex;

use crate::ingest::recording::{TimeColumn, Wanted};
use crate::join::Rule;
use crate::manifest::Manifest;
use crate::units::{Dimension, Unit};

/// Column of time of a trial that was joined; columns of sources have a dot.
pub const JOINED_TIME: &str = "time";

/// A column and its unit.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub column: String,
    pub unit: Unit,
}

/// Where the parts of a trial stand in a file.
#[derive(Debug)]
pub(crate) struct Layout {
    pub actuators: Vec<Source>,
    pub context: Vec<Source>,
    pub measured: Vec<Source>,
    pub predicted: Vec<Source>,
    pub vehicle: Vec<Source>,
    pub time: Clock,
    pub name: Naming,
    /// Samples are joined from several sources, and may lack what one of them has not.
    pub joined: bool,
    /// Outputs are markers with three coordinates each.
    pub markers: bool,
    /// Period of each column of a table that is unwrapped, in its unit.
    pub periods: BTreeMap<String, f64>,
    /// Quaternions of a table whose sign is kept.
    pub quaternions: Vec<[String; 4]>,
    /// How missing values of inputs are filled, by column.
    pub fill: BTreeMap<String, Rule>,
    time_column: Option<TimeColumn>,
    separator: Option<char>,
    decimal: Option<char>,
}

/// How a sample gets its time.
#[derive(Debug)]
pub(crate) enum Clock {
    /// A column of time stamps.
    Stamps(Source),
    /// A column of sample numbers, and their rate in Hz.
    Numbers(Source, f64),
    /// Samples in sequence at a rate in Hz.
    Rate(f64),
}

/// How a trial gets its name.
#[derive(Debug)]
pub(crate) enum Naming {
    Column(String),
    File(Regex),
    Stem,
}

impl Layout {
    /// The layout of a manifest that was validated; `None` for one that was not.
    pub fn new(manifest: &Manifest) -> Option<Layout> {
        let source =
            |column: &String, unit: &str| Some(Source { column: column.clone(), unit: Unit::parse(unit).ok()? });
        let all = |signals: &[crate::manifest::Signal]| -> Option<Vec<Source>> {
            signals.iter().map(|s| source(&s.column, &s.unit)).collect()
        };
        let mut vehicle = Vec::new();
        if let Some(carrier) = &manifest.vehicle {
            for column in &carrier.position {
                vehicle.push(source(column, &carrier.unit)?);
            }
            for column in &carrier.attitude {
                vehicle.push(source(column, carrier.attitude_unit.as_deref().unwrap_or("1"))?);
            }
        }
        let time = &manifest.table.time;
        let joined = !manifest.source.list.is_empty();
        let clock = match (&time.column, time.rate_hz) {
            _ if joined => Clock::Stamps(source(&JOINED_TIME.to_string(), "s")?),
            (Some(column), rate) => {
                // without a unit the column must have a type of time, and is never in another unit than seconds
                let source = source(column, time.unit.as_deref().unwrap_or("s"))?;
                match source.unit.dimension {
                    Dimension::Sample => Clock::Numbers(source, rate?),
                    _ => Clock::Stamps(source),
                }
            }
            (None, rate) => Clock::Rate(rate?),
        };
        let counts = matches!(clock, Clock::Numbers(..));
        let column = |column: &String| TimeColumn { column: column.clone(), unit: time.unit.clone(), counts };
        let time_column = time.column.as_ref().map(column);
        let inputs = manifest.actuator.iter().chain(&manifest.context);
        let name = match (&manifest.table.trial.column, &manifest.table.trial.file) {
            (Some(column), _) => Naming::Column(column.clone()),
            (None, Some(pattern)) => Naming::File(Regex::new(pattern).ok()?),
            (None, None) => Naming::Stem,
        };
        Some(Layout {
            actuators: all(&manifest.actuator)?,
            context: all(&manifest.context)?,
            measured: manifest.measured.iter().map(|m| source(&m.column, &m.unit)).collect::<Option<_>>()?,
            predicted: all(&manifest.predicted)?,
            vehicle,
            time: clock,
            name,
            joined,
            markers: manifest.has_markers(),
            periods: if joined { BTreeMap::new() } else { manifest.periods() },
            quaternions: manifest.table.quaternions.clone(),
            fill: inputs.filter_map(|signal| Some((signal.column.clone(), signal.fill?))).collect(),
            time_column,
            separator: manifest.table.separator.as_deref().and_then(|s| s.chars().next()),
            decimal: manifest.table.decimal.as_deref().and_then(|s| s.chars().next()),
        })
    }

    /// Columns to read from each file. Cells of outputs and of the vehicle may be empty.
    pub fn wanted(&self) -> Wanted {
        let mut numbers = BTreeMap::new();
        for source in self.measured.iter().chain(&self.vehicle) {
            numbers.insert(source.column.clone(), true);
        }
        for source in self.actuators.iter().chain(&self.context).chain(&self.predicted).chain(self.time.source()) {
            numbers.insert(source.column.clone(), self.fill.contains_key(&source.column));
        }
        let label = match &self.name {
            Naming::Column(column) => Some(column.clone()),
            _ => None,
        };
        Wanted { numbers, label, time: self.time_column.clone(), separator: self.separator, decimal: self.decimal }
    }

    /// Every signal that belongs to a sample, without its time.
    pub fn signals(&self) -> impl Iterator<Item = &Source> {
        let inputs = self.actuators.iter().chain(&self.context);
        inputs.chain(&self.measured).chain(&self.predicted).chain(&self.vehicle)
    }
}

impl Clock {
    /// The column of time, where there is one.
    pub fn source(&self) -> Option<&Source> {
        match self {
            Clock::Stamps(source) | Clock::Numbers(source, _) => Some(source),
            Clock::Rate(_) => None,
        }
    }

    /// Time in s of sample `i` with cell `value`.
    pub fn seconds(&self, i: usize, value: f64) -> f64 {
        match self {
            Clock::Stamps(source) => source.unit.to_si(value),
            Clock::Numbers(_, rate) => value / rate,
            Clock::Rate(rate) => i as f64 / rate,
        }
    }
}
