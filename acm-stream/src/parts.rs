//! Parts of an estimator, and their validation.
//!
//! | inputs of a sample, in order     | count          | unit           |
//! | -------------------------------- | -------------- | -------------- |
//! | actuators                        | A              | SI             |
//! | context signals, then conditions | E              | SI             |
//! | acceleration of the carrier x, y, z | 3 where the nominal model has a carrier | m/s² |
//! | predictions                      | M where the nominal model needs them | SI       |

use std::ops::Range;

use acm_core::NominalModel;
use acm_core::augmented::NeedsFuture;
use acm_kernels::{BuildError, Kernel, Shape};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::channel::{Channel, Source};
use crate::interval::Interval;
use crate::labels::Labels;
use crate::nominal::Nominal;
use crate::range::ChannelRange;
use crate::residual::StateRule;
use crate::scaler::Scaler;

/// Parts of an estimator.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parts {
    /// Names of the signals of a sample.
    pub signals: Signals,
    /// Nominal model.
    pub nominal: Nominal,
    /// Range of the nominal model's outputs that are returned: those of the tip.
    pub tip: Range<usize>,
    /// Inputs of the network.
    pub channels: Vec<Channel>,
    /// Smallest and largest value of each channel in training, SI; none in files of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ranges: Option<Vec<ChannelRange>>,
    /// Scaler of the channels.
    pub inputs: Scaler,
    /// Scaler of the residual.
    pub targets: Scaler,
    /// Shape of the network.
    #[serde(with = "crate::stored::StoredShape")]
    pub network: Shape,
    /// Parameters of the network in the order and layout of torch.
    pub weights: Vec<f32>,
    /// Weights of the other members of an ensemble, of the same shape; the output is the mean over all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Vec<f32>>,
    /// Shrinkage factor on the network's output, 0 to 1; 1 in files of earlier versions.
    #[serde(default = "whole")]
    pub factor: f64,
    /// Straight path beside the network, one row for each standardised channel and a last for the constant, with a weight for each
    /// output, SI; empty without a path.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub straight: Vec<Vec<f64>>,
    /// Gap after which the network's state is reset, s.
    pub max_gap: f64,
    /// Elapsed time at the first sample and at the first after a gap: the median step, s.
    pub first_elapsed: f64,
    /// Rule for the network's state.
    pub state: StateRule,
    /// Scale of each actuator where the network corrects the actuators beside the tip, SI; empty elsewhere. The nominal model is
    /// then an arm, and the network has an output for each actuator behind those of the tip.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub actuators: Vec<f64>,
    /// Prediction interval; none in files of earlier versions, or with fewer than two trials left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<Interval>,
    /// Names and units of inputs and outputs in the manifest; none in files of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub labels: Option<Labels>,
}

fn whole() -> f64 {
    1.0
}

/// Names of the signals of a sample.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signals {
    /// Names of the actuators, A of them.
    pub actuators: Vec<String>,
    /// Names of context signals, then of conditions, E of them.
    pub contexts: Vec<String>,
}

/// Reasons why parts are refused.
#[derive(Debug, Error, PartialEq)]
pub enum PartsError {
    /// A count does not match.
    #[error("{what}: {found} where {needed} are needed; take all parts from one run")]
    Count {
        /// Name of what was counted.
        what: &'static str,
        /// Number that was found.
        found: usize,
        /// Number that the other parts need.
        needed: usize,
    },
    /// A channel refers to a signal that does not exist.
    #[error("channel {channel} is {source_:?}, and there is no such signal; take all parts from one run")]
    Channel {
        /// Index of the channel.
        channel: usize,
        /// Source of the channel as given.
        source_: Source,
    },
    /// A scaler has an invalid value, or too few values.
    #[error("the scaler of the {what} needs {needed} finite means and positive spreads")]
    Scaler {
        /// Inputs or targets.
        what: &'static str,
        /// Number of columns.
        needed: usize,
    },
    /// A range is invalid.
    #[error(
        "the training range of channel {channel} is {low} to {high}; it must have two finite ends, the smaller first"
    )]
    Range {
        /// Index of the channel.
        channel: usize,
        /// Smallest value as given.
        low: f64,
        /// Largest value as given.
        high: f64,
    },
    /// A value is invalid.
    #[error("{what} is {value}; it must be {remedy}")]
    Value {
        /// Name of the value.
        what: &'static str,
        /// Value as given.
        value: f64,
        /// Accepted values.
        remedy: &'static str,
    },
    /// The nominal model needs future samples.
    #[error(transparent)]
    Nominal(#[from] NeedsFuture),
    /// The network corrects actuators, and the nominal model is no arm.
    #[error("the network corrects the actuators, and the nominal model is no arm; take all parts from one run")]
    NoArm,
    /// The network cannot be built.
    #[error(transparent)]
    Network(#[from] BuildError),
}

impl Parts {
    /// Returns the number of inputs of a sample.
    pub fn width(&self) -> usize {
        let signals = self.signals.actuators.len() + self.signals.contexts.len();
        signals + self.nominal.acceleration() + self.nominal.predicted()
    }

    /// Returns the labels; where the parts have none, those of the nominal model's signals.
    pub fn labelled(&self) -> Labels {
        let signals = self.signals.actuators.iter().chain(&self.signals.contexts);
        self.labels.clone().unwrap_or_else(|| Labels {
            inputs: self.nominal.input_labels(signals),
            outputs: self.nominal.output_labels(self.tip.clone()),
        })
    }

    /// Returns the kernel of the network, if all parts fit.
    pub(crate) fn kernel(&self) -> Result<Kernel, PartsError> {
        let count = |what, found: usize, needed: usize| match found == needed {
            true => Ok(()),
            false => Err(PartsError::Count { what, found, needed }),
        };
        let Signals { actuators, contexts } = &self.signals;
        match &self.nominal {
            Nominal::Model(NominalModel::Strain(model)) => count("actuators", actuators.len(), model.actuators())?,
            Nominal::Model(NominalModel::Polynomial(p)) => count("actuators", actuators.len(), p.actuators())?,
            Nominal::Augmented(model) => {
                count("actuators", actuators.len(), model.rig().actuators.len())?;
                count("contexts", contexts.len(), model.rig().contexts.len())?;
            }
            Nominal::Model(NominalModel::None { .. }) | Nominal::Given(_) => (),
        }
        let known = |source| match source {
            Source::Actuator(a) => a < actuators.len(),
            Source::Context(e) => e < contexts.len(),
        };
        if let Some(channel) = self.channels.iter().position(|channel| !known(channel.source)) {
            return Err(PartsError::Channel { channel, source_: self.channels[channel].source });
        }
        if self.tip.end > self.nominal.outputs() {
            return Err(PartsError::Count { what: "outputs", found: self.nominal.outputs(), needed: self.tip.end });
        }
        count("channels", self.channels.len(), self.network.inputs)?;
        count("outputs", self.tip.len() + self.actuators.len(), self.network.outputs)?;
        if !self.actuators.is_empty() {
            count("scales of actuators", self.actuators.len(), actuators.len())?;
            if self.nominal.arm().is_none() {
                return Err(PartsError::NoArm);
            }
        }
        for (what, scaler, needed) in
            [("inputs", &self.inputs, self.channels.len()), ("targets", &self.targets, self.tip.len())]
        {
            if !scaler.fits(needed) {
                return Err(PartsError::Scaler { what, needed });
            }
        }
        if let Some(ranges) = &self.ranges {
            count("training ranges", ranges.len(), self.channels.len())?;
            if let Some(channel) = ranges.iter().position(|range| !range.is_valid()) {
                let ChannelRange { low, high } = ranges[channel];
                return Err(PartsError::Range { channel, low, high });
            }
        }
        let positive = "a time above 0 s";
        for (what, value) in [("max_gap", self.max_gap), ("first_elapsed", self.first_elapsed)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(PartsError::Value { what, value, remedy: positive });
            }
        }
        if !(0.0..=1.0).contains(&self.factor) {
            return Err(PartsError::Value { what: "the factor", value: self.factor, remedy: "from 0 to 1" });
        }
        if !self.straight.is_empty() {
            count("rows of the straight path", self.straight.len(), self.channels.len() + 1)?;
        }
        for weights in &self.straight {
            count("weights of the straight path", weights.len(), self.tip.len())?;
            if let Some(&value) = weights.iter().find(|weight| !weight.is_finite()) {
                return Err(PartsError::Value {
                    what: "a weight of the straight path",
                    value,
                    remedy: "a finite number",
                });
            }
        }
        if let Some(interval) = &self.interval {
            count("half-widths", interval.half_widths.len(), self.tip.len())?;
            if !interval.is_valid() {
                let remedy = "above 0 and below 1, with half-widths of 0 or more";
                return Err(PartsError::Value { what: "the interval's level", value: interval.level, remedy });
            }
        }
        if let Some(labels) = &self.labels {
            count("names of inputs", labels.inputs.len(), self.width())?;
            count("names of outputs", labels.outputs.len(), self.tip.len())?;
        }
        if self.state == StateRule::Window(0) {
            return Err(PartsError::Value { what: "the window", value: 0.0, remedy: "at least 1 sample" });
        }
        let kernel = Kernel::new(&self.network)?;
        for weights in self.members.iter().chain([&self.weights]) {
            count("weights", weights.len(), kernel.parameters())?;
        }
        Ok(kernel)
    }
}
