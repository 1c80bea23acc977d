//! Value and rate of a sampled signal at any time, band-limited: a local straight line.
//!
//! ```text
//! min over (x, v) of  Σ_k K((t_k − t)/w)·(x_k − x − v·(t_k − t))²,      K(u) = (1 − |u|³)³ for |u| < 1
//! ```
//!
//! The window is symmetric, so that neither value nor rate is delayed, and needs no regular sampling: jitter and lost samples
//! cost precision alone. Both signals of a comparison are given the same `w`, and with it the same band.
//!
//! Source: Cleveland 1979, JASA 74(368).

use crate::join::series::Series;

/// Fewer samples than these in a window are a gap.
const FEWEST: usize = 4;

/// Value and rate at `time`; none where too few samples are within `w`, or all on one side.
pub fn local(series: &Series, time: f64, w: f64) -> Option<(f64, f64)> {
    let (start, end) = (series.from(time - w), series.from(time + w));
    if end - start < FEWEST || series.time[start] > time || series.time[end - 1] < time {
        return None;
    }
    let (mut s, mut st, mut stt, mut sx, mut stx) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let base = series.values[start];
    for k in start..end {
        let (t, x) = (series.time[k] - time, series.values[k] - base);
        let u = (t / w).abs();
        let weight = (1.0 - u * u * u).max(0.0).powi(3);
        s += weight;
        st += weight * t;
        stt += weight * t * t;
        sx += weight * x;
        stx += weight * t * x;
    }
    let determinant = s * stt - st * st;
    // all but one of the samples at the edge of the window, or at one place
    if !(determinant > 1e-3 * s * s * w * w / 16.0) {
        return None;
    }
    Some((base + (stt * sx - st * stx) / determinant, (s * stx - st * sx) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a straight line is met exactly, at irregular times; the rate of a slow sine to second order in w.
    #[test]
    fn lines_are_exact_and_curves_are_smoothed() {
        let time: Vec<f64> = (0..300).map(|k| 0.01 * f64::from(k) + 0.003 * f64::from(k * 7 % 5)).collect();
        let line: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
        let (value, rate) = local(&Series::new(&time, &line), 1.2345, 0.08).unwrap_or_default();
        assert!((value - 0.531).abs() < 1e-12 && (rate + 2.0).abs() < 1e-11, "{value} {rate}");
        let sine: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let series = Series::new(&time, &sine);
        let error = |w: f64| (local(&series, 1.5, w).unwrap_or_default().1 - 1.5f64.cos()).abs();
        assert!(error(0.08) < 1e-3, "{}", error(0.08));
        assert_eq!(local(&series, 3.5, 0.08), None, "behind the end");
        let gap = Series { time: vec![0.0, 0.01, 0.02, 0.03, 1.0], values: vec![0.0; 5] };
        assert_eq!(local(&gap, 0.5, 0.2), None);
    }
}
