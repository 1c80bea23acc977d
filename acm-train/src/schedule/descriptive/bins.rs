//! Bins of equal width over the actuator that is swept.
//!
//! ```text
//! bin(q) = ⌊(q − low) / width⌋,   the upper limit belongs to the last bin
//! ```

use std::ops::Range;

/// Limits of the bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bins {
    low: f64,
    width: f64,
    count: usize,
}

impl Bins {
    /// Returns `count` bins from the smallest to the largest of `values`.
    pub fn over(values: impl Iterator<Item = f64>, count: usize) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)));
        Self { low, width: (high - low) / count as f64, count }
    }

    /// Returns the index of the bin of a value within the limits; the first where all values are equal.
    pub fn of(&self, value: f64) -> usize {
        // A quotient of 0/0 is no number, and `as` makes it 0.
        (((value - self.low) / self.width) as usize).min(self.count.saturating_sub(1))
    }

    /// Returns the range of the bins.
    pub fn range(&self) -> Range<usize> {
        0..self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; four bins over [−1, 3] are 1 wide.
    #[test]
    fn limits_belong_to_the_bin_above_and_the_last_to_the_last() {
        let bins = Bins::over([3.0, -1.0, 0.2].into_iter(), 4);
        let of = [-1.0, -0.01, 0.0, 0.99, 1.0, 2.5, 3.0].map(|q| bins.of(q));
        assert_eq!(of, [0, 0, 1, 1, 2, 3, 3]);
        assert_eq!(Bins::over([2.0, 2.0].into_iter(), 5).of(2.0), 0);
    }
}
