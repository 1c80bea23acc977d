//! How far off an answer may be, as it was on trials left out of training.

use serde::{Deserialize, Serialize};

/// An interval about each answer: answer ± half-width, where the network was trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interval {
    /// Share of samples that it is to hold, from 0 to 1, over trials like those that it comes from.
    pub level: f64,
    /// One for each output of the tip, SI.
    pub half_widths: Vec<f64>,
}

impl Interval {
    /// Ends of the interval about output `o`, whose answer is `value`.
    pub fn ends(&self, o: usize, value: f64) -> [f64; 2] {
        [value - self.half_widths[o], value + self.half_widths[o]]
    }

    /// Whether it can be one.
    pub(crate) fn is_valid(&self) -> bool {
        let width = |width: &f64| *width >= 0.0 && width.is_finite();
        self.level > 0.0 && self.level < 1.0 && self.half_widths.iter().all(width)
    }
}
