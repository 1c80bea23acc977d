//! Learning rate schedules: the `schedule` of `[training]`; the equations are in [`crate::learn::optimizer::schedule`].

use serde::{Deserialize, Serialize};

use crate::config::parse::fault::TrainingFault;

/// Learning rate schedules.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Schedule {
    /// Constant learning rate.
    Constant,
    /// Half a cosine down to `floor` times the learning rate.
    Cosine {
        /// Share of the learning rate that is left at the end.
        #[serde(default)]
        floor: f64,
    },
    /// Factor `factor` after each `every` epochs.
    Step {
        /// Epochs between two steps.
        #[serde(default = "every")]
        every: usize,
        /// Factor on the learning rate.
        #[serde(default = "half")]
        factor: f64,
    },
    /// Factor `factor` when the validation loss has not fallen for `patience` epochs.
    Plateau {
        /// Number of epochs to wait.
        #[serde(default = "wait")]
        patience: usize,
        /// Factor on the learning rate.
        #[serde(default = "half")]
        factor: f64,
    },
}

fn half() -> f64 {
    0.5
}

fn every() -> usize {
    20
}

fn wait() -> usize {
    5
}

impl Schedule {
    pub(super) fn validate(&self) -> Result<(), TrainingFault> {
        let fault = |field, value: &dyn ToString, remedy| TrainingFault { field, value: value.to_string(), remedy };
        match self {
            Self::Cosine { floor } if !(0.0..=1.0).contains(floor) => {
                Err(fault("schedule.floor", floor, "write a share of the learning rate from 0 to 1, for example 0.01"))
            }
            Self::Step { every, .. } if !(1..=1_000_000).contains(every) => {
                Err(fault("schedule.every", every, "write 1 to 1000000 epochs, for example 20"))
            }
            Self::Plateau { patience, .. } if *patience > 1_000_000 => {
                Err(fault("schedule.patience", patience, "write 0 to 1000000 epochs, for example 5"))
            }
            Self::Step { factor, .. } | Self::Plateau { factor, .. } if !(*factor > 0.0 && *factor <= 1.0) => {
                Err(fault("schedule.factor", factor, "write a number above 0 and at most 1, for example 0.5"))
            }
            _ => Ok(()),
        }
    }
}
