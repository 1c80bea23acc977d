//! A change of slope with one actuator, as of a sensor that shows no sign: s max(0, q − κ).

use serde::{Deserialize, Serialize};

/// See the head of this file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kink {
    /// Index of the actuator.
    pub actuator: usize,
    /// Value κ of the actuator from which on the slope is another, SI.
    pub at: f64,
    /// Change s of the slope of each output, M.
    pub slopes: Vec<f64>,
}

impl Kink {
    /// Returns max(0, q − κ).
    pub(super) fn beyond(&self, q: &[f64]) -> f64 {
        (q[self.actuator] - self.at).max(0.0)
    }
}
