//! Samples as numbers in the units of a manifest, and answers in them.
//!
//! What a sample is worth is decided here, for lines ([`super::session`]) and for arrays alike: outside of the domain that the
//! calibration covers the nominal model answers alone.

use acm_datasets::Domain;
use acm_stream::{Interval, StepError};
use thiserror::Error;

use super::{robot::Robot, wiring::Wiring};

/// Estimator with inputs and answers in the units of its manifest.
pub struct Sampler {
    robot: Robot,
    wiring: Wiring,
    /// Domain in which the network answers; everywhere without one.
    domain: Option<Domain>,
    /// Samples behind the last answer.
    history: u64,
    inputs: Vec<f64>,
}

/// A row of a trial that cannot be answered.
#[derive(Debug, Error, PartialEq)]
#[error("row {row}: {error}")]
pub struct RowError {
    /// Index of the row, from 0.
    pub row: usize,
    /// Reason of the refusal.
    pub error: StepError,
}

impl Sampler {
    /// Returns a sampler before the first sample.
    pub fn new(robot: Robot, wiring: Wiring, domain: Option<Domain>) -> Self {
        let inputs = vec![0.0; wiring.inputs.len()];
        Self { robot, wiring, domain, history: 0, inputs }
    }

    /// Returns the columns of inputs and outputs.
    pub fn wiring(&self) -> &Wiring {
        &self.wiring
    }

    /// Takes a sample `elapsed` seconds after the one before; `written` holds the inputs in order, each in its column's unit.
    ///
    /// # Errors
    /// A sample that cannot be taken; nothing changes.
    pub fn step(&mut self, written: &[f64], elapsed: f64) -> Result<(), StepError> {
        let (found, needed) = (written.len(), self.inputs.len());
        if found != needed {
            return Err(StepError::Count { found, needed });
        }
        for ((input, value), column) in self.inputs.iter_mut().zip(written).zip(&self.wiring.inputs) {
            *input = column.unit.to_si(*value);
        }
        let actuators = &self.inputs[..self.wiring.actuator_count()];
        let seen = self.domain.as_ref().is_none_or(|domain| domain.contains(actuators));
        self.robot.step(&self.inputs, elapsed, seen)?;
        self.history = if seen { self.robot.history() } else { 0 };
        Ok(())
    }

    /// Answers a whole trial from its start: `row` writes the inputs of a row, `time` gives its time in the unit of its column, and
    /// `answered` is called after each row.
    ///
    /// # Errors
    /// The first row that is no sample; those before it were answered.
    pub fn trial(
        &mut self,
        rows: usize,
        time: impl Fn(usize) -> f64,
        row: impl Fn(usize, &mut [f64]),
        mut answered: impl FnMut(usize, &Self),
    ) -> Result<(), RowError> {
        self.restart();
        let (mut written, mut before) = (vec![0.0; self.inputs.len()], None);
        for k in 0..rows {
            row(k, &mut written);
            let seconds = self.wiring.clock.seconds(k as u64, time(k));
            let elapsed = before.map_or(0.0, |before| seconds - before);
            self.step(&written, elapsed).map_err(|error| RowError { row: k, error })?;
            before = Some(seconds);
            answered(k, self);
        }
        Ok(())
    }

    /// Returns the last answers, each in its output's unit.
    pub fn outputs(&self) -> impl Iterator<Item = f64> {
        self.in_units(self.robot.tip())
    }

    /// Returns the answer of the nominal model alone, each in its output's unit.
    pub fn nominal(&self) -> impl Iterator<Item = f64> {
        self.in_units(self.robot.nominal())
    }

    fn in_units<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = f64> {
        self.wiring.outputs.iter().zip(values).map(|(column, value)| value / column.unit.factor())
    }

    /// Returns the ends of the interval about output `o`, in its unit; none without an interval, or where the network
    /// did not answer.
    pub fn ends(&self, o: usize) -> Option<[f64; 2]> {
        let interval = self.interval().filter(|_| self.history > 0)?;
        Some(interval.ends(o, self.robot.tip()[o]).map(|end| end / self.wiring.outputs[o].unit.factor()))
    }

    /// Returns the interval of the answers, where there is one.
    pub fn interval(&self) -> Option<&Interval> {
        self.robot.interval()
    }

    /// Returns the number of samples behind the last answer; 0 where the nominal model answered alone.
    pub fn history(&self) -> u64 {
        self.history
    }

    /// Returns whether the last sample was in the range of training.
    pub fn in_range(&self) -> Option<bool> {
        self.robot.in_range()
    }

    /// Resets the states, so that another trial can begin.
    pub fn restart(&mut self) {
        self.robot.restart();
    }
}
