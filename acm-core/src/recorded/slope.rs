//! Rate of change of a signal on irregular time stamps: the slope of a straight line through a sample and its neighbours.

/// Samples on each side that a rate of change is fitted to.
pub const REACH: usize = 2;

/// Slope of a straight line through each sample and its two neighbours on either side, per second.
pub fn slope(time: &[f64], values: &[f64]) -> Vec<f64> {
    (0..time.len()).map(|t| slope_at(time, values, t)).collect()
}

/// Samples of a line with all neighbours.
const ALL: usize = 2 * REACH + 1;

/// Slope at sample `t` alone.
pub fn slope_at(time: &[f64], values: &[f64], t: usize) -> f64 {
    let near = t.saturating_sub(REACH)..(t + REACH + 1).min(time.len());
    let (time, values) = (&time[near.clone()], &values[near]);
    // Of a known number of samples the sums are unrolled.
    match (<&[f64; ALL]>::try_from(time), <&[f64; ALL]>::try_from(values)) {
        (Ok(time), Ok(values)) => line(time, values),
        _ => line(time, values),
    }
}

#[inline(always)]
fn line(time: &[f64], values: &[f64]) -> f64 {
    let count = time.len() as f64;
    let mean_time = time.iter().sum::<f64>() / count;
    let mean = values.iter().sum::<f64>() / count;
    let spread: f64 = time.iter().map(|time| (time - mean_time).powi(2)).sum();
    let joint: f64 = time.iter().zip(values).map(|(time, value)| (time - mean_time) * (value - mean)).sum();
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
