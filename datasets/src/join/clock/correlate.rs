//! Offset of one signal in another: cross-correlation of their rates over all offsets.
//!
//! ```text
//! ρ(l) = Σ_i r_i·s_{i−l} / √(Σ_i r_i² · Σ_i s_{i−l}²)        over the i where both are known
//! ```
//!
//! | symbol | meaning | unit |
//! | `r`, `s` | rates of reference and source on a grid of step g | 1/s |
//! | `l` | offset, in steps | 1 |
//!
//! A short overlap has large correlations by chance. Under white noise of unknown power the log-likelihood ratio of an offset is
//! `−n/2·ln(1 − ρ²)`, n the pairs that are known: offsets are ranked by it. The sign of ρ is free, since a marker may go down where a
//! motor goes up.

/// The grid has so many products at most; a longer log is looked at more coarsely.
pub const PRODUCTS: f64 = 2e9;

/// Points of a grid, at most.
pub const POINTS: f64 = 1e6;

/// Smallest power that is left over: offsets between two steps of the grid are not met exactly.
const LEFT: f64 = 0.01;

/// A peak of the correlation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Offset in steps.
    pub lag: i64,
    /// Correlation, between −1 and 1.
    pub correlation: f64,
    /// Pairs that are known.
    pub count: usize,
}

impl Peak {
    /// Twice the log-likelihood ratio, if all pairs are independent.
    pub fn evidence(&self) -> f64 {
        -(self.count as f64) * (1.0 - self.correlation.powi(2)).max(LEFT).ln()
    }
}

/// Correlates over the offsets `lags`, where `fewest` pairs or more are known. The peaks, best first: between two of them |ρ| falls
/// below half of the greatest, or changes its sign.
pub fn correlate(r: &[f64], s: &[f64], lags: std::ops::RangeInclusive<i64>, fewest: usize) -> Vec<Peak> {
    let all: Vec<Peak> = lags.map(|lag| at(r, s, lag, fewest)).collect();
    let size = |peak: &Peak| peak.correlation.abs();
    let greatest = all.iter().map(size).fold(0.0, f64::max);
    let is_part = |peak: &Peak| greatest > 0.0 && size(peak) >= 0.5 * greatest;
    let one = |a: &Peak, b: &Peak| is_part(a) && is_part(b) && (a.correlation > 0.0) == (b.correlation > 0.0);
    let lobes = all.chunk_by(one).filter(|lobe| is_part(&lobe[0]));
    let top = |lobe: &[Peak]| lobe.iter().copied().reduce(|a, b| if size(&b) > size(&a) { b } else { a });
    let mut peaks: Vec<Peak> = lobes.filter_map(top).collect();
    peaks.sort_by(|a, b| b.evidence().total_cmp(&a.evidence()));
    peaks
}

/// ρ at one offset; 0 where too few pairs are known. NaN is unknown.
fn at(r: &[f64], s: &[f64], lag: i64, fewest: usize) -> Peak {
    let (from, to) = (lag.max(0), (r.len() as i64).min(s.len() as i64 + lag));
    let none = Peak { lag, correlation: 0.0, count: 0 };
    if to - from < fewest as i64 {
        return none;
    }
    let (r, s) = (&r[from as usize..to as usize], &s[(from - lag) as usize..(to - lag) as usize]);
    let (mut rs, mut rr, mut ss, mut count) = (0.0, 0.0, 0.0, 0);
    for (r, s) in r.iter().zip(s) {
        let product = r * s;
        if !product.is_nan() {
            rs += product;
            rr += r * r;
            ss += s * s;
            count += 1;
        }
    }
    if count < fewest || rr == 0.0 || ss == 0.0 {
        none
    } else {
        Peak { lag, correlation: rs / (rr * ss).sqrt(), count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: planted.
    #[test]
    fn a_shifted_signal_is_found_and_a_repeated_one_at_each_period() {
        let signal = |k: i64| ((k * k) as f64 * 0.01).sin();
        let s: Vec<f64> = (0..200).map(signal).collect();
        let r: Vec<f64> = (0..100).map(|k| -2.0 * signal(k + 37)).collect();
        let found = correlate(&r, &s, -150..=150, 60)[0];
        assert!(found.lag == -37 && (found.correlation + 1.0).abs() < 1e-9, "{found:?}");
        let wave = |k: i64| (k as f64 * std::f64::consts::TAU / 20.0).sin();
        let [r, s]: [Vec<f64>; 2] = [(0..100).map(wave).collect(), (0..200).map(|k| wave(k + 5)).collect()];
        let peaks = correlate(&r, &s, -100..=20, 60);
        let mut lags: Vec<i64> = peaks.iter().filter(|peak| peak.correlation > 0.99).map(|peak| peak.lag).collect();
        lags.sort_unstable();
        assert_eq!(lags, [-95, -75, -55, -35, -15, 5]);
    }

    /// Oracle: by hand; the short overlap has the greater correlation, the long one more evidence.
    #[test]
    fn a_long_overlap_counts_for_more_than_a_short_one() {
        let peak = |correlation, count| Peak { lag: 0, correlation, count };
        assert!(peak(0.9, 200).evidence() > peak(-0.92, 100).evidence());
        assert!(peak(0.9, 200).evidence() < peak(-0.99, 100).evidence());
    }
}
