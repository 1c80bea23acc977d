//! History of the actuators before a trial, which sets the initial memory of effects.
//!
//! | form | ahead of the first sample | for |
//! | --- | --- | --- |
//! | turn | the actuators rest at their first values, and turn at others in between | play, friction, hysteresis: memory of reversals |
//! | rest | the actuators rest at other values | lags whose time depends on their state: memory of time |

use acm_core::record::Record;
use acm_core::{resting, turning};

/// What the actuators did before a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Before {
    /// They rested at these values.
    Rest(Vec<f64>),
    /// They rested at the first values of the trial, and turned at these.
    Turn(Vec<f64>),
}

impl Before {
    /// Returns a record that begins with the history.
    pub fn ahead_of(&self, record: &Record) -> Record {
        match self {
            Self::Rest(rest) => resting(record, rest),
            Self::Turn(turn) => turning(record, turn),
        }
    }

    /// Returns the number of samples that it adds.
    pub fn samples(&self) -> usize {
        match self {
            Self::Rest(_) => 1,
            Self::Turn(_) => 2,
        }
    }

    /// Returns the value of each actuator.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Rest(values) | Self::Turn(values) => values,
        }
    }
}
