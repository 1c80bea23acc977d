//! Offset from an event that both sources recorded: a button, a lamp, a clap.
//!
//! ```text
//! offset = e_ref − e_source ± (d_ref + d_source)/2
//! ```
//!
//! e: the middle of the first two samples of which the first is not above the threshold and the second is; d: their distance.

use crate::join::series::Series;

/// Where a series first rises above a threshold: the time, and the distance of the two samples around it, s.
pub fn rise(series: &Series, above: f64) -> Option<(f64, f64)> {
    let k = (1..series.values.len()).find(|k| series.values[k - 1] <= above && series.values[*k] > above)?;
    Some(((series.time[k - 1] + series.time[k]) / 2.0, series.time[k] - series.time[k - 1]))
}

/// Offset and half of its interval, s.
pub fn offset(reference: (&Series, f64), source: (&Series, f64)) -> Option<(f64, f64)> {
    let (r, s) = (rise(reference.0, reference.1)?, rise(source.0, source.1)?);
    Some((r.0 - s.0, (r.1 + s.1) / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn the_first_rise_of_both_is_the_same_instant() {
        let series = |times: &[f64], values: &[f64]| Series { time: times.to_vec(), values: values.to_vec() };
        let reference = series(&[0.0, 0.1, 0.2, 0.3], &[0.0, 0.0, 1.0, 1.0]);
        let source = series(&[5.0, 5.04, 5.08, 5.12], &[3.0, 0.1, 0.1, 4.0]);
        let (offset, half) = offset((&reference, 0.5), (&source, 2.0)).unwrap_or_default();
        assert!((offset - (0.15 - 5.10)).abs() < 1e-12 && (half - 0.07).abs() < 1e-12, "{offset} {half}");
        assert_eq!(rise(&source, 9.0), None);
    }
}
