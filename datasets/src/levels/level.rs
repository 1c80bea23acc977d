//! Mean and spread of a signal within a trial.

/// Mean and spread of a signal over the samples of a trial, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Mean.
    pub mean: f64,
    /// Variance.
    pub variance: f64,
}

impl Level {
    /// Of samples; 0 where there are none.
    pub fn of<'a>(values: impl ExactSizeIterator<Item = &'a f64> + Clone) -> Self {
        let count = values.len().max(1) as f64;
        let mean = values.clone().sum::<f64>() / count;
        Self { mean, variance: values.map(|value| (value - mean).powi(2)).sum::<f64>() / count }
    }
}
