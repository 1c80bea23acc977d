//! Rate of change of a signal on irregular time stamps: the slope of a straight line through a sample and its neighbours.

/// Samples on each side that a rate of change is fitted to.
pub const REACH: usize = 2;

/// Slope of a straight line through each sample and its two neighbours on either side, per second.
pub fn slope(time: &[f64], values: &[f64]) -> Vec<f64> {
    (0..time.len()).map(|t| slope_at(time, values, t)).collect()
}

/// Slope at sample `t` alone.
pub fn slope_at(time: &[f64], values: &[f64], t: usize) -> f64 {
    let near = t.saturating_sub(REACH)..=(t + REACH).min(time.len() - 1);
    let count = near.clone().count() as f64;
    let mean_time = near.clone().map(|k| time[k]).sum::<f64>() / count;
    let mean = near.clone().map(|k| values[k]).sum::<f64>() / count;
    let spread: f64 = near.clone().map(|k| (time[k] - mean_time).powi(2)).sum();
    let joint: f64 = near.map(|k| (time[k] - mean_time) * (values[k] - mean)).sum();
    if spread > 0.0 { joint / spread } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a straight line has its slope everywhere, on irregular time stamps.
    #[test]
    fn a_line_has_one_slope() {
        let time = [0.0, 0.1, 0.25, 0.3, 1.0, 1.1];
        let values: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
        assert!(slope(&time, &values).iter().all(|v| (v + 2.0).abs() < 1e-12));
        assert_eq!(slope(&[1.0], &[5.0]), [0.0]);
    }
}
