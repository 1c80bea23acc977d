//! Training ranges of the channels.
//!
//! A network gives an answer to any input. Only between the smallest and the largest training value of each channel
//! can it be an interpolation, and even there not for every combination of channels.

use serde::{Deserialize, Serialize};

/// Tolerance for rounding, as a share of the range's width. A value of training may lie outside of its range by
/// rounding: time stamps are subtracted in another order on a robot than in training.
const ROUNDING: f64 = 1e-9;

/// Smallest and largest value of a channel in training, in the channel's SI unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelRange {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl ChannelRange {
    /// Returns the range of some values; none where there are no values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let points = values.into_iter().map(|value| Self { low: value, high: value });
        points.reduce(|a, b| Self { low: a.low.min(b.low), high: a.high.max(b.high) })
    }

    /// Returns whether a value lies inside, its ends included.
    pub fn contains(&self, value: f64) -> bool {
        let slack = ROUNDING * (self.high - self.low).max(self.low.abs()).max(self.high.abs());
        value >= self.low - slack && value <= self.high + slack
    }

    /// Returns whether its bounds are valid.
    pub(crate) fn is_valid(&self) -> bool {
        self.low.is_finite() && self.high.is_finite() && self.low <= self.high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_ends_belong_to_it() {
        let range = ChannelRange::of([0.3, -1.0, 2.0]).unwrap();
        assert_eq!(range, ChannelRange { low: -1.0, high: 2.0 });
        assert!([-1.0, 0.0, 2.0, 2.0 + 1e-12].into_iter().all(|value| range.contains(value)));
        assert!([-1.001, 2.001, f64::NAN, f64::INFINITY].into_iter().all(|value| !range.contains(value)));
        assert_eq!(ChannelRange::of([]), None);
        let still = ChannelRange::of([0.5, 0.5]).unwrap();
        assert!(still.contains(0.5) && !still.contains(0.500_001));
    }
}
