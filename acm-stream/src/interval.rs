//! Prediction intervals, from errors on trials left out of training.

use serde::{Deserialize, Serialize};

/// A prediction interval: answer ± half-width, valid in the training range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Coverage of samples, 0 to 1, over trials like those that the level comes from.
    pub level: f64,
    /// Half-width for each output of the tip, SI.
    pub half_widths: Vec<f64>,
}

impl Interval {
    /// Returns the bounds of the interval of output `o`, whose answer is `value`.
    pub fn ends(&self, o: usize, value: f64) -> [f64; 2] {
        [value - self.half_widths[o], value + self.half_widths[o]]
    }

    /// Returns whether its values are valid.
    pub(crate) fn is_valid(&self) -> bool {
        let width = |width: &f64| *width >= 0.0 && width.is_finite();
        self.level > 0.0 && self.level < 1.0 && self.half_widths.iter().all(width)
    }
}
