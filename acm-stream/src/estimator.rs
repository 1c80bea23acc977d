//! The estimator: from signals to the tip, sample by sample.

use acm_core::augmented::Sample;
use thiserror::Error;

use crate::moved::Moved;
use crate::nominal::Running;
use crate::parts::{Parts, PartsError};
use crate::residual::Residual;

/// Largest magnitude of an answer; larger ones count as not finite, since a change of unit would overflow.
const LARGEST: f64 = 1e290;

/// Tolerance of the gap limit for rounded time stamps, as in training.
const ROUNDING: f64 = 1.0 + 1e-9;

/// A nominal model and a network with their states during a trial.
#[derive(Debug)]
pub struct Estimator {
    parts: Parts,
    nominal: Running,
    /// Networks; several of an ensemble.
    residuals: Vec<Residual>,
    /// Time since the first sample, s; none before it.
    time: Option<f64>,
    /// Number of samples that the network processed since the first, or since the last gap.
    history: u64,
    /// Inputs of the last of them.
    before: Vec<f64>,
    /// Time from it to the last sample of all, s.
    unseen: f64,
    /// Index of each channel's signal among the inputs.
    places: Vec<usize>,
    /// The last answer, and the next one while it is computed.
    answer: Answer,
    next: Answer,
    /// Standardised inputs of the network.
    channels: Vec<f32>,
    predicted: Vec<f32>,
    /// Sum of the networks' residuals, SI.
    added: Vec<f64>,
    /// Correction of the actuators, where the network has one.
    moved: Option<Moved>,
}

/// Answer to one sample.
#[derive(Debug, Clone)]
struct Answer {
    /// All outputs of the nominal model, SI.
    markers: Vec<f64>,
    tip: Vec<f64>,
    /// Whether each channel lay in its training range; unknown without ranges.
    in_range: Option<bool>,
}

/// Reasons why a sample is refused. The estimator is then unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StepError {
    /// Wrong number of inputs.
    #[error("{found} inputs where {needed} are needed")]
    Count {
        /// Number of inputs as given.
        found: usize,
        /// Number that the parts need.
        needed: usize,
    },
    /// An input is NaN or infinite.
    #[error("input {index} is {value}; leave the sample out, and add its time to that of the next")]
    NotFinite {
        /// Index, counted from 0.
        index: usize,
        /// Value as given.
        value: f64,
    },
    /// A value computed from the sample is not finite.
    #[error(
        "{what} {index} comes out as {value}, so large are the inputs; leave the sample out, and add its time to that of the next"
    )]
    Overflow {
        /// Name of the value that is too large: `channel`, `the nominal model's output` or `output`.
        what: &'static str,
        /// Index, counted from 0.
        index: usize,
        /// The computed value.
        value: f64,
    },
    /// The elapsed time is not positive.
    #[error("{elapsed} s since the sample before; time must pass: leave the sample out, or restart for a new trial")]
    Elapsed {
        /// Elapsed time as given, s.
        elapsed: f64,
    },
}

impl Estimator {
    /// Returns the estimator before the first sample of a trial.
    ///
    /// # Errors
    /// The parts do not fit together.
    pub fn new(parts: Parts) -> Result<Self, PartsError> {
        let kernel = parts.kernel()?;
        let actuators = parts.signals.actuators.len();
        let answer =
            Answer { markers: vec![0.0; parts.nominal.outputs()], tip: vec![0.0; parts.tip.len()], in_range: None };
        Ok(Self {
            nominal: Running::new(&parts.nominal)?,
            residuals: std::iter::once(&parts.weights)
                .chain(&parts.members)
                .map(|weights| Residual::new(&kernel, weights, parts.state))
                .collect(),
            time: None,
            history: 0,
            before: vec![0.0; parts.width()],
            unseen: 0.0,
            places: parts.channels.iter().map(|channel| channel.place(actuators)).collect(),
            next: answer.clone(),
            answer,
            channels: vec![0.0; parts.channels.len()],
            predicted: vec![0.0; parts.network.outputs],
            added: vec![0.0; parts.tip.len()],
            moved: match parts.actuators.is_empty() {
                true => None,
                false => Moved::new(&parts.nominal, &parts.actuators, parts.tip.clone()),
            },
            parts,
        })
    }

    /// Returns the parts of the estimator.
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Returns the tip at the next sample, SI. `inputs` are in the order of [`Parts`]; `elapsed` is the time since the previous
    /// sample, s, and is ignored at the first.
    ///
    /// # Errors
    /// The sample is refused, and the estimator is unchanged. Where effects overflow at inputs below 1e12, they are reset.
    pub fn step(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        let elapsed = self.predict_nominal(inputs, elapsed)?;
        let since = self.unseen + elapsed;
        let begins = self.begins(since);
        self.see(inputs, since, begins);
        if let Some(moved) = &mut self.moved {
            moved.look(&inputs[..self.parts.signals.actuators.len()]);
        }
        if let Err(error) = self.add_residual(since, begins) {
            self.nominal.undo();
            return Err(error);
        }
        self.before.copy_from_slice(inputs);
        (self.unseen, self.history) = (0.0, if begins { 1 } else { self.history + 1 });
        self.commit(elapsed);
        Ok(&self.answer.tip)
    }

    /// Returns the nominal prediction at a sample that the network must not process, since its actuators are outside of the
    /// training domain. Effects process the sample; for the network only time elapses, as in training.
    ///
    /// # Errors
    /// As [`Estimator::step`].
    pub fn step_unseen(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        let elapsed = self.predict_nominal(inputs, elapsed)?;
        let since = self.unseen + elapsed;
        self.see(inputs, since, self.begins(since));
        self.next.tip.copy_from_slice(&self.next.markers[self.parts.tip.clone()]);
        self.unseen = since;
        self.commit(elapsed);
        Ok(&self.answer.tip)
    }

    /// Returns the answer to the last sample, SI.
    pub fn tip(&self) -> &[f64] {
        &self.answer.tip
    }

    /// Returns the nominal prediction at the last sample, SI.
    pub fn nominal(&self) -> &[f64] {
        &self.answer.markers[self.parts.tip.clone()]
    }

    /// Returns whether each channel of the last sample lay between the smallest and the largest value that it had in
    /// training, SI; rates of change are channels as well. None before the first sample, and where the parts have no
    /// `ranges`.
    ///
    /// This includes samples that the network does not process. Outside the range the network extrapolates.
    pub fn in_range(&self) -> Option<bool> {
        self.answer.in_range
    }

    /// Returns the number of samples that the network processed since the first, or since the last gap. Scores in
    /// training begin with a full window.
    pub fn history(&self) -> u64 {
        self.history
    }

    /// Resets all states, for a new trial.
    pub fn restart(&mut self) {
        self.nominal.restart();
        self.residuals.iter_mut().for_each(Residual::restart);
        (self.time, self.history, self.unseen) = (None, 0, 0.0);
        self.answer.in_range = None;
    }

    fn check(&self, inputs: &[f64], elapsed: f64) -> Result<(), StepError> {
        let (found, needed) = (inputs.len(), self.before.len());
        if found != needed {
            return Err(StepError::Count { found, needed });
        }
        if let Some(index) = inputs.iter().position(|value| !value.is_finite()) {
            return Err(StepError::NotFinite { index, value: inputs[index] });
        }
        let passes = elapsed > 0.0 && (self.time.unwrap_or(0.0) + elapsed).is_finite();
        if self.time.is_some() && !passes { Err(StepError::Elapsed { elapsed }) } else { Ok(()) }
    }

    /// Returns the time since the previous sample, 0 s at the first.
    fn predict_nominal(&mut self, inputs: &[f64], elapsed: f64) -> Result<f64, StepError> {
        self.check(inputs, elapsed)?;
        let elapsed = if self.time.is_some() { elapsed } else { 0.0 };
        let time = self.time.unwrap_or(0.0) + elapsed;
        let signals = &self.parts.signals;
        let (actuators, rest) = inputs.split_at(signals.actuators.len());
        let (contexts, rest) = rest.split_at(signals.contexts.len());
        let (acceleration, predicted) = rest.split_at(self.parts.nominal.acceleration());
        let sample = Sample { time, actuators, contexts, acceleration, predicted };
        self.nominal.step(&sample, &mut self.next.markers);
        finite("the nominal model's output", self.next.markers.iter().copied())
            .inspect_err(|_| self.nominal.undo())
            .map(|()| elapsed)
    }

    /// Returns whether a sample `since` seconds after the last that the network processed begins a new segment.
    fn begins(&self, since: f64) -> bool {
        self.history == 0 || since > self.parts.max_gap * ROUNDING
    }

    /// Computes the channels of a sample, and whether they are in the training range.
    fn see(&mut self, inputs: &[f64], since: f64, begins: bool) {
        let Parts { channels, inputs: scaler, ranges, .. } = &self.parts;
        let mut inside = true;
        for (c, (channel, &place)) in channels.iter().zip(&self.places).enumerate() {
            let value = match channel.rate {
                false => inputs[place],
                true if begins => 0.0,
                true => (inputs[place] - self.before[place]) / since,
            };
            inside &= ranges.as_ref().is_none_or(|ranges| ranges[c].contains(value));
            self.channels[c] = scaler.standardise(c, value);
        }
        self.next.in_range = ranges.as_ref().map(|_| inside);
    }

    fn add_residual(&mut self, since: f64, begins: bool) -> Result<(), StepError> {
        finite("channel", self.channels.iter().copied().map(f64::from))?;
        let Parts { targets, tip, factor, first_elapsed, .. } = &self.parts;
        let elapsed = if begins { *first_elapsed } else { since };
        self.added.fill(0.0);
        for residual in &mut self.residuals {
            residual.step(begins, &self.channels, elapsed as f32, &mut self.predicted);
            for (o, (added, predicted)) in self.added.iter_mut().zip(&self.predicted).enumerate() {
                *added += targets.restore(o, *predicted);
                *added += self.moved.as_ref().map_or(0.0, |moved| moved.of(o, &self.predicted[tip.len()..]));
            }
        }
        let (nominal, count) = (&self.next.markers[tip.clone()], self.residuals.len() as f64);
        for (o, ((out, nominal), added)) in self.next.tip.iter_mut().zip(nominal).zip(&self.added).enumerate() {
            let refined = factor * (added / count);
            *out = nominal + straight(&self.parts.straight, &self.channels, o).map_or(refined, |path| refined + path);
        }
        finite("output", self.next.tip.iter().copied())
            .inspect_err(|_| self.residuals.iter_mut().for_each(Residual::undo))
    }

    /// Makes the next answer the present one.
    fn commit(&mut self, elapsed: f64) {
        self.time = Some(self.time.unwrap_or(0.0) + elapsed);
        std::mem::swap(&mut self.answer, &mut self.next);
    }
}

/// Returns the straight path's share of output `o`, where there is a path.
fn straight(weights: &[Vec<f64>], channels: &[f32], o: usize) -> Option<f64> {
    let (constant, weights) = weights.split_last()?;
    let products = weights.iter().zip(channels).map(|(row, channel)| row[o] * f64::from(*channel));
    Some(products.fold(constant[o], |sum, product| sum + product))
}

/// Refuses the first value that is not finite or too large.
fn finite(what: &'static str, values: impl IntoIterator<Item = f64>) -> Result<(), StepError> {
    let found = values.into_iter().enumerate().find(|(_, value)| value.is_nan() || value.abs() > LARGEST);
    found.map_or(Ok(()), |(index, value)| Err(StepError::Overflow { what, index, value }))
}
