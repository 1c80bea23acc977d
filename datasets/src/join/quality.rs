//! Sampling quality of a source: jitter and gaps.

use super::series::median;
use super::signals::Signals;

/// Facts of one source of one trial; of a log that holds many trials, of all of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Quality {
    /// Robust standard deviation of the steps in time, s: 1.4826 times their median absolute deviation.
    pub jitter: f64,
    /// Stretches of empty cells within a column, such as occlusions, over all columns that are read.
    pub occlusions: usize,
    /// The longest of them, from the last value before it to the first behind it, s.
    pub longest: f64,
}

impl Quality {
    /// Quality of the columns that were read.
    pub fn of(signals: &Signals) -> Quality {
        let most = signals.axes.iter().max_by_key(|axis| axis.time.len());
        let steps: Vec<f64> = most.iter().flat_map(|axis| axis.time.windows(2)).map(|pair| pair[1] - pair[0]).collect();
        let middle = median(&steps);
        let jitter = 1.4826 * median(&steps.iter().map(|step| (step - middle).abs()).collect::<Vec<_>>());
        let mut quality = Quality { jitter, ..Quality::default() };
        for (axis, values) in signals.columns.values() {
            let Some(axis) = signals.axes.get(*axis) else { continue };
            let present: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
            for pair in present.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
                quality.occlusions += 1;
                quality.longest = quality.longest.max(axis.time[pair[1]] - axis.time[pair[0]]);
            }
        }
        quality
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::join::signals::Axis;

    /// Oracle: by hand.
    #[test]
    fn stretches_of_empty_cells_are_occlusions() {
        let time: Vec<f64> = [0.0, 1.0, 2.0, 3.1, 4.0, 5.0, 6.0].to_vec();
        let none = f64::NAN;
        let values = vec![none, 1.0, none, none, 2.0, none, 3.0];
        let columns = [("x".to_string(), (0, values))].into();
        let signals = Signals { columns, axes: vec![Axis { time, first_row: 1 }], ..Signals::default() };
        let quality = Quality::of(&signals);
        assert_eq!((quality.occlusions, quality.longest), (2, 3.0));
        assert!(quality.jitter.abs() < 1e-12, "four of six steps are 1 s: {}", quality.jitter);
    }
}
