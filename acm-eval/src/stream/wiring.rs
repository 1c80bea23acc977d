//! Columns of a line, the signals that they carry, and their units.

use crate::error::EvalError;
use acm_core::augmented::AugmentedModel;
use acm_datasets::{
    Manifest,
    join::TIME,
    manifest::{Measured, Signal},
    units::{Dimension, Unit},
};
use acm_stream::{Channel, Label, Labels, ManifestUnit, Nominal, Source};

/// A column of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name as in the manifest, or of a condition.
    pub name: String,
    /// Name of the signal, where the manifest gives it one beside that of its column; of the column elsewhere.
    pub signal: String,
    /// Unit of the written values.
    pub unit: Unit,
}

/// Source of a sample's time.
#[derive(Debug, Clone, PartialEq)]
pub enum Clock {
    /// A column of time stamps.
    Stamps(Column),
    /// A column of sample numbers, and their rate in Hz.
    Numbers(Column, f64),
    /// Rate in Hz of consecutive samples, without a column.
    Rate(f64),
}

/// Columns of a line in the order of an estimator's inputs, and the channels made of them.
#[derive(Debug, Clone)]
pub struct Wiring {
    /// Source of the time.
    pub clock: Clock,
    /// Columns of actuators, contexts, acceleration, predictions.
    pub inputs: Vec<Column>,
    /// The network's channels by place among them.
    pub channels: Vec<Channel>,
    /// Columns of the answers.
    pub outputs: Vec<Column>,
    /// Separator between the cells of a line.
    pub separator: char,
    actuators: usize,
    contexts: usize,
}

impl Wiring {
    /// Returns the columns for the channels of a network, and its nominal model.
    ///
    /// # Errors
    /// A signal that the manifest lacks, or a unit that is not known.
    pub fn new(manifest: &Manifest, channels: &[acm_datasets::Channel], nominal: &Nominal) -> Result<Self, EvalError> {
        let model = match nominal {
            Nominal::Augmented(model) => Some(model),
            _ => None,
        };
        let actuators = signals(&manifest.actuator)?;
        let known = contexts(manifest)?;
        // A model with effects knows all contexts by their place; a network alone needs its own.
        let mut contexts: Vec<&(String, Column)> = match model {
            None => vec![],
            Some(model) => (model.rig().contexts.iter())
                .map(|signal| known.iter().find(|(name, _)| *name == signal.name).ok_or_else(|| lost(&signal.name)))
                .collect::<Result<_, _>>()?,
        };
        let mut wired = vec![];
        for channel in channels {
            let inner = channel.name.strip_prefix("rate(").and_then(|name| name.strip_suffix(')')).map(str::trim);
            let (name, rate) = (inner.unwrap_or(&channel.name), inner.is_some());
            let place = manifest.actuator.iter().position(|signal| is_called(signal, name));
            let source = match place {
                Some(actuator) => Source::Actuator(actuator),
                None => {
                    let called = |(own, column): &&(String, Column)| own == name || column.name == name;
                    let context = known.iter().find(called).ok_or_else(|| lost(name))?;
                    let listed = contexts.iter().position(|listed| listed.0 == context.0);
                    Source::Context(listed.unwrap_or_else(|| {
                        contexts.push(context);
                        contexts.len() - 1
                    }))
                }
            };
            wired.push(Channel { source, rate });
        }
        let (counted, contexts) = (contexts.len(), contexts.into_iter().map(|(_, column)| column.clone()));
        let mut inputs: Vec<Column> = actuators.iter().cloned().chain(contexts).collect();
        if model.is_some_and(|model| model.rig().carried) {
            for axis in ["x", "y", "z"] {
                inputs.push(Column::new(format!("acceleration_{axis}"), unit("m/s^2")?));
            }
        }
        let given = matches!(nominal, Nominal::Given(_));
        if given || model.is_some_and(AugmentedModel::needs_prediction) {
            inputs.extend(signals(&manifest.predicted)?);
        }
        let tip = &manifest.measured[manifest.tip_columns()];
        let output = |m: &Measured| Ok(Column::new(m.name(), unit(&m.unit)?));
        Ok(Self {
            clock: clock(manifest)?,
            inputs,
            channels: wired,
            outputs: tip.iter().map(output).collect::<Result<_, EvalError>>()?,
            separator: manifest.table.separator.as_deref().and_then(|s| s.chars().next()).unwrap_or(','),
            actuators: actuators.len(),
            contexts: counted,
        })
    }

    /// Returns the columns of an estimator that states only the names of its inputs: all in SI units, with time stamps
    /// in s.
    ///
    /// # Errors
    /// None that is known.
    pub fn in_si(inputs: &[String], outputs: usize) -> Result<Self, EvalError> {
        let si = unit("1")?;
        let column = |name: String| Column::new(name, si);
        Ok(Self {
            clock: Clock::Stamps(Column::new(TIME, unit("s")?)),
            inputs: inputs.iter().cloned().map(column).collect(),
            channels: vec![],
            outputs: (0..outputs).map(|o| column(format!("output_{o}"))).collect(),
            separator: ',',
            actuators: inputs.len(),
            contexts: 0,
        })
    }

    /// Adds the inputs of another that it lacks; both have all actuators first.
    pub fn with(mut self, other: &Self) -> Self {
        let new = other.inputs.iter().filter(|column| !self.inputs.contains(column)).cloned().collect::<Vec<_>>();
        self.inputs.extend(new);
        self
    }

    /// Returns the indices of the inputs of another among these.
    pub fn places(&self, other: &Self) -> Vec<usize> {
        let place = |column: &Column| self.inputs.iter().position(|own| own == column).unwrap_or(self.inputs.len());
        other.inputs.iter().map(place).collect()
    }

    /// Returns the number of actuators, which come first.
    pub fn actuator_count(&self) -> usize {
        self.actuators
    }

    /// Returns the names of the actuators.
    pub fn actuators(&self) -> Vec<String> {
        self.inputs[..self.actuators].iter().map(|column| column.name.clone()).collect()
    }

    /// Returns the names of the contexts.
    pub fn contexts(&self) -> Vec<String> {
        self.inputs[self.actuators..self.actuators + self.contexts].iter().map(|column| column.name.clone()).collect()
    }

    /// Returns names and units of inputs and outputs, for an estimator that goes elsewhere.
    pub fn labels(&self) -> Labels {
        let all = |columns: &[Column]| columns.iter().map(Column::label).collect();
        Labels { inputs: all(&self.inputs), outputs: all(&self.outputs) }
    }

    /// Returns the column of time, where there is one.
    pub fn time(&self) -> Option<&Column> {
        match &self.clock {
            Clock::Stamps(column) | Clock::Numbers(column, _) => Some(column),
            Clock::Rate(_) => None,
        }
    }
}

impl Column {
    /// Returns a column whose signal has no other name.
    pub fn new(name: impl Into<String>, unit: Unit) -> Self {
        let name = name.into();
        Self { signal: name.clone(), name, unit }
    }

    fn label(&self) -> Label {
        let column = (self.name != self.signal).then(|| self.name.clone());
        Label { column, manifest: manifest_unit(&self.unit), ..Label::in_si(&self.signal, self.unit.si_name()) }
    }
}

/// Returns a unit with its value in SI; none where it is the SI unit itself.
pub fn manifest_unit(unit: &Unit) -> Option<ManifestUnit> {
    let offset = unit.to_si(0.0);
    let factor = unit.to_si(1.0) - offset;
    let is_si = unit.name == unit.si_name() || (factor == 1.0 && offset == 0.0);
    (!is_si).then(|| ManifestUnit { unit: unit.name.into(), factor, offset })
}

impl Clock {
    /// Returns the time in s of the sample number `k`, whose cell is `value`.
    pub fn seconds(&self, k: u64, value: f64) -> f64 {
        match self {
            Clock::Stamps(column) => column.unit.to_si(value),
            Clock::Numbers(_, rate) => value / rate,
            Clock::Rate(rate) => k as f64 / rate,
        }
    }
}

/// Returns the clock. Lines of several sources come on one clock, with a column of time as `acm-data join` names it.
fn clock(manifest: &Manifest) -> Result<Clock, EvalError> {
    if !manifest.source.list.is_empty() {
        return Ok(Clock::Stamps(Column::new(TIME, unit("s")?)));
    }
    let time = &manifest.table.time;
    Ok(match (&time.column, time.rate_hz) {
        (None, rate) => Clock::Rate(rate.unwrap_or(1.0)),
        (Some(name), rate) => {
            let column = Column::new(name, unit(time.unit.as_deref().unwrap_or("s"))?);
            match column.unit.dimension {
                Dimension::Sample => Clock::Numbers(column, rate.unwrap_or(1.0)),
                _ => Clock::Stamps(column),
            }
        }
    })
}

/// Returns context signals, then conditions, by name.
fn contexts(manifest: &Manifest) -> Result<Vec<(String, Column)>, EvalError> {
    let mut all: Vec<(String, Column)> = vec![];
    for signal in &manifest.context {
        all.push((signal.name().to_string(), column(signal)?));
    }
    for (name, quantity) in manifest.conditions.values().flatten() {
        if all.iter().all(|(known, _)| known != name) {
            all.push((name.clone(), Column::new(name, unit(&quantity.unit)?)));
        }
    }
    Ok(all)
}

fn signals(signals: &[Signal]) -> Result<Vec<Column>, EvalError> {
    signals.iter().map(column).collect()
}

fn column(signal: &Signal) -> Result<Column, EvalError> {
    Ok(Column { signal: signal.name().into(), ..Column::new(&signal.column, unit(&signal.unit)?) })
}

fn is_called(signal: &Signal, name: &str) -> bool {
    signal.name() == name || signal.column == name
}

fn unit(name: &str) -> Result<Unit, EvalError> {
    Unit::parse(name).map_err(|error| EvalError::Data(format!("the manifest names an {error}; train again")))
}

fn lost(name: &str) -> EvalError {
    EvalError::Data(format!("the run uses a signal {name}, and the manifest has none; bring the former manifest back"))
}
