//! Actuator history of a trial.

use serde::{Deserialize, Serialize};

/// What the actuators did before one trial; see the head of `series::before`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BeforeTrial {
    /// Name of the trial.
    pub trial: String,
    /// What the values mean.
    pub form: BeforeForm,
    /// Value of each actuator, SI.
    pub values: Vec<f64>,
}

/// What an actuator did at a value before a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BeforeForm {
    /// It rested there.
    Rest,
    /// It rested at its first value, and then turned there.
    Turn,
}
