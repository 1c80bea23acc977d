//! Columns of time types: instants, days, times of day and durations, in whole ticks.
//!
//! ```text
//! instants, days, times of day   t_i = (tick_i − tick_0) / ticks per second     from the trial's first sample
//! durations                      t_i =  tick_i           / ticks per second     as they are
//! ```
//!
//! The difference is one of integers: an instant in ns since 1970 needs 61 bits, and a float holds 53.

/// A type of time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TickType {
    /// As pyarrow prints it: `timestamp[ns]`.
    pub name: String,
    /// The unit of a manifest that says the same; days have none.
    pub unit: &'static str,
    /// Ticks per second; 1 where a tick is a second or longer.
    pub per_second: i64,
    /// Seconds of a tick; 1 where it is a second or shorter.
    pub seconds: i64,
    /// Whether it counts from an origin of its own.
    pub duration: bool,
    /// Whether it is a date without a zone, which a change to or from daylight saving time moves.
    pub local: bool,
}

/// The column of time of one recording.
#[derive(Debug, Clone)]
pub(crate) struct Ticks {
    pub kind: TickType,
    /// `None` is an empty cell.
    pub values: Vec<Option<i64>>,
}

impl Ticks {
    /// Some of the samples.
    pub fn select(&self, samples: &[usize]) -> Ticks {
        Ticks { kind: self.kind.clone(), values: samples.iter().map(|i| self.values[*i]).collect() }
    }

    /// Time of day at which the clock was set back by an hour, if it was between two samples: the first, as `02:59:59.980`.
    pub fn set_back(&self, first: usize, second: usize) -> Option<String> {
        let seconds = |tick: i64| tick as f64 * self.kind.seconds as f64 / self.kind.per_second as f64;
        let (before, after) = (self.values[first]?, self.values[second]?);
        let an_hour = (3540.0..=3660.0).contains(&seconds(before.saturating_sub(after)));
        let day = seconds(before.rem_euclid(86_400 * self.kind.per_second / self.kind.seconds));
        let (hours, minutes) = (day as u32 / 3600, day as u32 / 60 % 60);
        (self.kind.local && an_hour).then(|| format!("{hours:02}:{minutes:02}:{:06.3}", day % 60.0))
    }

    /// First instant, ns since the origin of the type; durations have none.
    pub fn origin(&self) -> Option<i128> {
        let first = self.values.iter().find_map(|tick| *tick).filter(|_| !self.kind.duration)?;
        Some(i128::from(first) * i128::from(self.kind.seconds) * 1_000_000_000 / i128::from(self.kind.per_second))
    }

    /// Time of the samples of one trial, s; NaN for an empty cell.
    pub fn seconds(&self, samples: &[usize]) -> Vec<f64> {
        let first = samples.iter().find_map(|i| self.values[*i]).filter(|_| !self.kind.duration).unwrap_or(0);
        let seconds =
            |tick: i64| tick.saturating_sub(first) as f64 * self.kind.seconds as f64 / self.kind.per_second as f64;
        samples.iter().map(|i| self.values[*i].map_or(f64::NAN, seconds)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(per_second: i64, seconds: i64, duration: bool, values: &[i64]) -> Vec<f64> {
        let kind = TickType { name: String::new(), unit: "", per_second, seconds, duration, local: false };
        let ticks = Ticks { kind, values: values.iter().copied().map(Some).collect() };
        ticks.seconds(&(0..values.len()).collect::<Vec<_>>())
    }

    /// Oracle: by hand. Steps of 1 ns at 1.7·10¹⁸ ns, where neighbouring floats are 256 apart.
    #[test]
    fn nanoseconds_since_1970_keep_each_of_them() {
        let start = 1_700_000_000_000_000_000;
        assert_eq!(ticks(1_000_000_000, 1, false, &[start, start + 1, start + 3]), [0.0, 1e-9, 3e-9]);
        assert_eq!(ticks(1000, 1, true, &[1500, 1750]), [1.5, 1.75]);
        assert_eq!(ticks(1, 86_400, false, &[20_000, 20_002]), [0.0, 172_800.0]);
        assert!(ticks(1, 86_400, false, &[i64::MIN, i64::MAX])[1].is_finite());
    }
}
