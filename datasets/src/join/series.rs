//! One column of one source on its own clock: valid samples in the order of time.

/// Times `[N]`, s, increasing, and finite values `[N]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// s.
    pub time: Vec<f64>,
    /// In the source's unit.
    pub values: Vec<f64>,
}

impl Series {
    /// The samples whose value is finite.
    pub fn new(time: &[f64], values: &[f64]) -> Self {
        let present = time.iter().zip(values).filter(|(_, value)| value.is_finite());
        let (time, values) = present.map(|(time, value)| (*time, *value)).unzip();
        Self { time, values }
    }

    /// Median step, s; 0 of fewer than two samples.
    pub fn step(&self) -> f64 {
        let mut steps: Vec<f64> = self.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if steps.is_empty() {
            return 0.0;
        }
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// First and last time, s.
    pub fn span(&self) -> Option<(f64, f64)> {
        Some((*self.time.first()?, *self.time.last()?))
    }

    /// Index of the first sample at `time` or after it.
    pub fn from(&self, time: f64) -> usize {
        self.time.partition_point(|t| *t < time)
    }

    /// The samples that are no outliers.
    ///
    /// ```text
    /// |x_k − m_k| ≤ 5·1.4826·MAD_k + 0.001·range        m_k, MAD_k: of the seven samples around it
    /// ```
    ///
    /// Hampel's identifier (Davies and Gather 1993, JASA 88(423)); the second term spares coarse encoders, whose MAD is 0.
    pub fn without_outliers(&self) -> Series {
        let range = self.range();
        let keep = |k: usize| {
            let around = &self.values[k.saturating_sub(3)..(k + 4).min(self.values.len())];
            let middle = median(around);
            let spread: Vec<f64> = around.iter().map(|value| (value - middle).abs()).collect();
            (self.values[k] - middle).abs() <= 5.0 * 1.4826 * median(&spread) + 1e-3 * range
        };
        let kept = (0..self.values.len()).filter(|k| keep(*k));
        let (time, values) = kept.map(|k| (self.time[k], self.values[k])).unzip();
        Series { time, values }
    }

    /// Range from the first to the 99th percentile.
    fn range(&self) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => 0.0,
            count => sorted[count - 1 - count / 100] - sorted[count / 100],
        }
    }
}

/// Median of some values; 0 of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        count if count % 2 == 1 => sorted[count / 2],
        count => (sorted[count / 2 - 1] + sorted[count / 2]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: planted.
    #[test]
    fn outliers_are_left_out_and_steps_are_not() {
        let time: Vec<f64> = (0..200).map(|k| f64::from(k) / 100.0).collect();
        let mut values: Vec<f64> = time.iter().map(|t| (6.0 * t).sin()).collect();
        values[50] += 3.0;
        values[120] = f64::NAN;
        let clean = Series::new(&time, &values).without_outliers();
        assert_eq!(clean.time.len(), 198);
        assert!(!clean.time.contains(&time[50]) && clean.step() > 0.0099);
        let steps: Vec<f64> = (0..200).map(|k| f64::from(k / 40)).collect();
        assert_eq!(Series::new(&time, &steps).without_outliers().time.len(), 200);
    }
}
