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
//! The sign of ρ is free, since a marker may go down where a motor goes up.

/// The grid has so many products at most; a longer log is looked at more coarsely.
pub const PRODUCTS: f64 = 2e9;

/// A peak of the correlation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Offset in steps.
    pub lag: i64,
    /// Correlation, between −1 and 1.
    pub correlation: f64,
}

/// The best offset, and the best of the others that are no part of its peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The greatest |ρ|.
    pub best: Peak,
    /// The greatest beyond the places where |ρ| first falls below half of it.
    pub rival: Option<Peak>,
}

/// Correlates over the offsets `lags`, where `fewest` pairs or more are known.
pub fn correlate(r: &[f64], s: &[f64], lags: std::ops::RangeInclusive<i64>, fewest: usize) -> Option<Found> {
    let all: Vec<(i64, f64)> = lags.map(|lag| (lag, at(r, s, lag, fewest))).collect();
    let size = |i: usize| all[i].1.abs();
    let best = (0..all.len()).filter(|i| all[*i].1 != 0.0).max_by(|a, b| size(*a).total_cmp(&size(*b)))?;
    let low = |i: &usize| size(*i) < 0.5 * size(best);
    let (from, to) = ((0..best).rev().find(low), (best..all.len()).find(low));
    let outside = (0..from.unwrap_or(0)).chain(to.unwrap_or(all.len())..all.len());
    let rival = outside.max_by(|a, b| size(*a).total_cmp(&size(*b)));
    let peak = |i: usize| Peak { lag: all[i].0, correlation: all[i].1 };
    Some(Found { best: peak(best), rival: rival.filter(|i| all[*i].1 != 0.0).map(peak) })
}

/// ρ at one offset; 0 where too few pairs are known. NaN is unknown.
fn at(r: &[f64], s: &[f64], lag: i64, fewest: usize) -> f64 {
    let (from, to) = (lag.max(0), (r.len() as i64).min(s.len() as i64 + lag));
    if to - from < fewest as i64 {
        return 0.0;
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
    if count < fewest || rr == 0.0 || ss == 0.0 { 0.0 } else { rs / (rr * ss).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: planted.
    #[test]
    fn a_shifted_signal_is_found_and_a_repeated_one_has_a_rival() {
        let signal = |k: i64| ((k * k) as f64 * 0.01).sin();
        let s: Vec<f64> = (0..200).map(signal).collect();
        let r: Vec<f64> = (0..100).map(|k| -2.0 * signal(k + 37)).collect();
        let found = correlate(&r, &s, -150..=150, 60).map(|f| f.best);
        assert!(found.is_some_and(|peak| peak.lag == -37 && (peak.correlation + 1.0).abs() < 1e-9), "{found:?}");
        let wave = |k: i64| (k as f64 * 0.3).sin();
        let [r, s]: [Vec<f64>; 2] = [(0..100).map(wave).collect(), (0..200).map(|k| wave(k + 5)).collect()];
        let rival = correlate(&r, &s, -100..=20, 60).and_then(|f| f.rival);
        assert!(rival.is_some_and(|peak| peak.correlation.abs() > 0.9), "{rival:?}");
    }
}
