//! Axis limits, with ticks at 1, 2 or 5 times a power of ten.

use crate::tables::fixed;

/// Limits of an axis, and the distance between its ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
    step: f64,
}

/// Largest value that is shown. Larger ones are invalid, and would hide all others.
const LARGEST: f64 = 1e15;

impl Scale {
    /// Returns limits around all values that are numbers, with a margin; −1 to 1 where there are none.
    pub fn holding(values: impl IntoIterator<Item = f64>, ticks: usize) -> Self {
        let (low, high) = extent(values).unwrap_or((-1.0, 1.0));
        let room = if high > low { 0.04 * (high - low) } else { (0.1 * high.abs()).max(1e-6) };
        Self::exactly(low - room, high + room, ticks)
    }

    /// Returns the scale from zero to a little more than the largest value.
    pub fn from_zero(values: impl IntoIterator<Item = f64>, ticks: usize) -> Self {
        let high = extent(values).map_or(0.0, |(_, high)| high);
        Self::exactly(0.0, if high > 0.0 { 1.06 * high } else { 1.0 }, ticks)
    }

    /// Returns the scale from `low` to `high`, with about `ticks` intervals.
    pub fn exactly(low: f64, high: f64, ticks: usize) -> Self {
        let raw = (high - low) / ticks.max(1) as f64;
        let power = 10f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| raw <= step * (1.0 + 1e-9));
        Self { low, high, step: step.unwrap_or(raw) }
    }

    /// Returns the positions of the ticks, with their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let decimals = (-self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        let (first, last) = ((self.low / self.step).ceil(), (self.high / self.step).floor());
        let count = if last >= first { (last - first) as usize + 1 } else { 0 };
        let at = |k: usize| (first + k as f64) * self.step;
        (0..count.min(30)).map(|k| (at(k), fixed(at(k), decimals))).collect()
    }

    /// Returns 0 at the lower limit, 1 at the upper; none for a value outside, or no number.
    pub fn share(&self, value: f64) -> Option<f64> {
        let share = (value - self.low) / (self.high - self.low);
        (-1e-9..=1.0 + 1e-9).contains(&share).then_some(share)
    }
}

fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let numbers = values.into_iter().filter(|value| value.abs() < LARGEST);
    numbers.fold(None, |found, v| Some(found.map_or((v, v), |(low, high): (f64, f64)| (low.min(v), high.max(v)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_hold_the_numbers_and_ticks_are_round() {
        let scale = Scale::from_zero([3.0, f64::NAN, 44.9, f64::INFINITY], 5);
        let labels: Vec<String> = scale.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "10", "20", "30", "40"]);
        assert!(scale.high > 44.9 && scale.high < 50.0);
        let small = Scale::holding([-0.013, 0.021], 4);
        assert_eq!(
            small.ticks().iter().map(|tick| tick.1.as_str()).collect::<Vec<_>>(),
            ["−0.01", "0.00", "0.01", "0.02"]
        );
    }

    #[test]
    fn nothing_to_hold_still_makes_an_axis() {
        for scale in [Scale::holding([], 5), Scale::holding([7.0, 7.0], 5), Scale::from_zero([f64::NAN], 5)] {
            assert!(scale.high > scale.low && !scale.ticks().is_empty(), "{scale:?}");
        }
    }
}
