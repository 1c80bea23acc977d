//! The estimator: sample by sample, from signals to the tip.

use acm_core::augmented::Sample;
use thiserror::Error;

use crate::nominal::Running;
use crate::parts::{Parts, PartsError};
use crate::residual::Residual;

/// A longer step than the limit, but for the rounding of time stamps: as in training.
const ROUNDING: f64 = 1.0 + 1e-9;

/// A nominal model and a network under way through a trial.
#[derive(Debug)]
pub struct Estimator {
    parts: Parts,
    nominal: Running,
    residual: Residual,
    /// Seconds since the first sample; none before it.
    time: Option<f64>,
    /// Samples that the network saw since the first, or since the last gap.
    history: u64,
    /// Inputs of the last of them.
    before: Vec<f64>,
    /// Seconds from it to the last sample of all.
    unseen: f64,
    /// Place of each channel's signal among the inputs.
    places: Vec<usize>,
    channels: Vec<f32>,
    predicted: Vec<f32>,
    markers: Vec<f64>,
    tip: Vec<f64>,
}

/// A sample that cannot be taken. The estimator stays as it was before it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StepError {
    /// Too many values, or too few.
    #[error("{found} inputs where {needed} are needed")]
    Count {
        /// As given.
        found: usize,
        /// By the parts.
        needed: usize,
    },
    /// NaN or infinite.
    #[error("input {index} is {value}; leave the sample out, and add its time to that of the next")]
    NotFinite {
        /// From 0.
        index: usize,
        /// As given.
        value: f64,
    },
    /// A time that does not pass.
    #[error("{elapsed} s since the sample before; time must pass: leave the sample out, or restart for a new trial")]
    Elapsed {
        /// As given.
        elapsed: f64,
    },
}

impl Estimator {
    /// Before the first sample of a trial.
    ///
    /// # Errors
    /// Parts that do not fit.
    pub fn new(parts: Parts) -> Result<Self, PartsError> {
        let kernel = parts.kernel()?;
        let actuators = parts.signals.actuators.len();
        Ok(Self {
            nominal: Running::new(&parts.nominal),
            residual: Residual::new(kernel.stepper(&parts.weights), parts.channels.len(), parts.state),
            time: None,
            history: 0,
            before: vec![0.0; parts.width()],
            unseen: 0.0,
            places: parts.channels.iter().map(|channel| channel.place(actuators)).collect(),
            channels: vec![0.0; parts.channels.len()],
            predicted: vec![0.0; parts.tip.len()],
            markers: vec![0.0; parts.nominal.outputs()],
            tip: vec![0.0; parts.tip.len()],
            parts,
        })
    }

    /// What it is made of.
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// The tip at the next sample, SI: `inputs` in the order of [`Parts`], `elapsed` seconds after the sample before; of
    /// the first sample it says nothing.
    ///
    /// # Errors
    /// A sample that cannot be taken; the estimator stays as it was.
    pub fn step(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        let elapsed = self.unseen + self.predict_nominal(inputs, elapsed)?;
        if self.history == 0 || elapsed > self.parts.max_gap * ROUNDING {
            self.residual.restart();
            self.history = 0;
        }
        self.add_residual(inputs, elapsed);
        self.before.copy_from_slice(inputs);
        self.unseen = 0.0;
        self.history += 1;
        Ok(&self.tip)
    }

    /// A sample that the network does not see, for actuators outside of what it was trained on: what the nominal model
    /// alone says. Its effects remember the sample, and to the network it is time that passed, as in training.
    ///
    /// # Errors
    /// As [`Estimator::step`].
    pub fn step_unseen(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        self.unseen += self.predict_nominal(inputs, elapsed)?;
        self.tip.copy_from_slice(&self.markers[self.parts.tip.clone()]);
        Ok(&self.tip)
    }

    /// What it answered to the last sample, SI.
    pub fn tip(&self) -> &[f64] {
        &self.tip
    }

    /// What the nominal model alone said of the last sample, SI.
    pub fn nominal(&self) -> &[f64] {
        &self.markers[self.parts.tip.clone()]
    }

    /// Samples that the network saw since the first, or since the last gap: training begins to score when a window is full.
    pub fn history(&self) -> u64 {
        self.history
    }

    /// Forgets the trial, so that another can begin.
    pub fn restart(&mut self) {
        self.nominal.restart();
        self.residual.restart();
        (self.time, self.history, self.unseen) = (None, 0, 0.0);
    }

    fn check(&self, inputs: &[f64], elapsed: f64) -> Result<(), StepError> {
        let (found, needed) = (inputs.len(), self.before.len());
        if found != needed {
            return Err(StepError::Count { found, needed });
        }
        if let Some(index) = inputs.iter().position(|value| !value.is_finite()) {
            return Err(StepError::NotFinite { index, value: inputs[index] });
        }
        let passes = elapsed > 0.0 && elapsed.is_finite();
        if self.time.is_some() && !passes { Err(StepError::Elapsed { elapsed }) } else { Ok(()) }
    }

    /// Returns the time since the sample before, 0 s at the first.
    fn predict_nominal(&mut self, inputs: &[f64], elapsed: f64) -> Result<f64, StepError> {
        self.check(inputs, elapsed)?;
        let elapsed = if self.time.is_some() { elapsed } else { 0.0 };
        let time = self.time.unwrap_or(0.0) + elapsed;
        self.time = Some(time);
        let signals = &self.parts.signals;
        let (actuators, rest) = inputs.split_at(signals.actuators.len());
        let (contexts, rest) = rest.split_at(signals.contexts.len());
        let (acceleration, predicted) = rest.split_at(self.parts.nominal.acceleration());
        self.nominal.step(&Sample { time, actuators, contexts, acceleration, predicted }, &mut self.markers);
        Ok(elapsed)
    }

    fn add_residual(&mut self, inputs: &[f64], elapsed: f64) {
        let Parts { channels, inputs: scaler, targets, tip, first_elapsed, .. } = &self.parts;
        let begins = self.history == 0;
        for (c, (channel, &place)) in channels.iter().zip(&self.places).enumerate() {
            let value = match channel.rate {
                false => inputs[place],
                true if begins => 0.0,
                true => (inputs[place] - self.before[place]) / elapsed,
            };
            self.channels[c] = scaler.standardise(c, value);
        }
        let elapsed = if begins { *first_elapsed } else { elapsed };
        self.residual.step(&self.channels, elapsed as f32, &mut self.predicted);
        let nominal = &self.markers[tip.clone()];
        for (o, (out, nominal)) in self.tip.iter_mut().zip(nominal).enumerate() {
            *out = nominal + targets.restore(o, self.predicted[o]);
        }
    }
}
