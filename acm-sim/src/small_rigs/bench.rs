//! A rig on the bench: what each kind draws before it is recorded.

use super::drive::Drive;
use super::recorded::{Cause, Counterpart, Signal, Value};
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::plants::term::Term;

/// An input: its signal and its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Name and unit.
    pub signal: Signal,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl Input {
    /// Returns an input of a name, a unit and a range.
    pub fn new(name: &str, unit: &str, low: f64, high: f64) -> Self {
        Self { signal: Signal::new(name, unit), low, high }
    }

    /// Returns the width of its range.
    pub fn range(&self) -> f64 {
        self.high - self.low
    }

    /// Returns the middle of its range.
    pub fn centre(&self) -> f64 {
        0.5 * (self.low + self.high)
    }
}

/// Inputs and output of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Ports {
    /// Title in one line, for a reader.
    pub title: &'static str,
    /// Actuators.
    pub actuators: Vec<Input>,
    /// Contexts.
    pub contexts: Vec<Input>,
    /// Output.
    pub output: Signal,
}

/// A plant and its causes while they are put together.
pub struct Bench {
    /// The plant so far.
    pub plant: Plant,
    /// Causes so far.
    pub causes: Vec<Cause>,
}

/// A mechanism and the effect that should be named for it.
pub struct Named<'a> {
    /// The simulated mechanism.
    pub mechanism: &'a str,
    /// Name of the effect.
    pub effect: &'a str,
    /// The signal that it acts on.
    pub signal: Option<&'a str>,
}

impl<'a> Named<'a> {
    /// Returns a mechanism named as its effect.
    pub fn new(effect: &'a str, signal: Option<&'a str>) -> Self {
        Self { mechanism: effect, effect, signal }
    }

    /// Renames the mechanism.
    pub fn called(self, mechanism: &'a str) -> Self {
        Self { mechanism, ..self }
    }
}

impl Bench {
    /// Returns a bench with a plant to be built up.
    pub fn new(plant: Plant) -> Self {
        Self { plant, causes: vec![] }
    }

    /// Adds a stage that is no cause.
    pub fn given_stage(&mut self, stage: Stage, free: impl IntoIterator<Item = Free>) {
        self.plant.stage(stage, free);
    }

    /// Adds a stage that is a cause.
    pub fn stage(&mut self, named: &Named, stage: Stage, free: impl IntoIterator<Item = Free>) {
        let free = self.cause(named, free);
        self.plant.stage(stage, free);
    }

    /// Adds a term that is no cause.
    pub fn given_term(&mut self, term: Term, free: impl IntoIterator<Item = Free>) {
        self.plant.term(term, free);
    }

    /// Adds a term that is a cause.
    pub fn term(&mut self, named: &Named, term: Term, free: impl IntoIterator<Item = Free>) {
        let free = self.cause(named, free);
        self.plant.term(term, free);
    }

    /// Adds a cause and marks its values.
    pub fn cause(&mut self, named: &Named, free: impl IntoIterator<Item = Free>) -> Vec<Free> {
        let number = self.causes.len();
        let free: Vec<Free> = free.into_iter().map(|free| Free { cause: Some(number), ..free }).collect();
        let value = |free: &Free| Value { name: free.name.clone(), value: free.value, unit: free.unit.clone() };
        self.causes.push(Cause {
            mechanism: named.mechanism.into(),
            counterpart: Some(Counterpart { effect: named.effect.into(), signal: named.signal.map(Into::into) }),
            parameters: free.iter().map(value).collect(),
        });
        free
    }
}

/// Returns the root mean square of some values about their mean.
pub fn spread(values: &[f64]) -> f64 {
    let many = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / many;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / many).sqrt()
}

/// Returns the factor by which a term of unit size moves the output of a drive by `wanted`.
pub fn sized(term: &Term, unit: &[f64], drive: &Drive, wanted: f64) -> f64 {
    let mut output = vec![0.0; drive.asked.len()];
    term.add(unit, drive, &mut output);
    wanted / spread(&output).max(1e-12)
}
