//! Inputs of the network: signals, and their rates of change.
//!
//! ```text
//! rate(q)_k = (q_k − q_{k−1})/Δt_k,   0 at the first sample and after a gap
//! ```

use serde::{Deserialize, Serialize};

/// One input of the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Signal of the channel.
    pub source: Source,
    /// Whether the channel is the signal's rate of change, per second.
    pub rate: bool,
}

/// A signal of a sample, by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Index of an actuator.
    Actuator(usize),
    /// Index of a context.
    Context(usize),
}

impl Channel {
    /// Returns the index among the inputs of a sample, which begin with `actuators` actuators.
    pub(crate) fn place(&self, actuators: usize) -> usize {
        match self.source {
            Source::Actuator(a) => a,
            Source::Context(e) => actuators + e,
        }
    }
}
