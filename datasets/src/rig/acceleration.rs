//! Acceleration of the carrier from its position.
//!
//! ```text
//! p(t) ≈ a + b τ + c τ²,   τ = (t − t_0)/h,   weight (1 − τ²)²  for |τ| < 1,   p̈ = 2c/h²
//! ```
//!
//! | symbol | meaning                                                          | unit |
//! | ------ | ---------------------------------------------------------------- | ---- |
//! | `t_0`  | the sample; near an end of the record, the nearest time whose window is whole | s |
//! | `h`    | half the window's width: 0.8 s, doubled until the window holds 5 samples      | s |
//!
//! Time stamps may be irregular. A parabola has one acceleration, so within h of an end the nearest whole window
//! speaks: one-sided windows would be noisier by far. Savitzky & Golay (1964); weights as in Cleveland (1979), LOESS.

use nalgebra::{Matrix3, Vector3};

/// Half the width of the window, s. Carriers fly manoeuvres of seconds; motion capture is noisy within tenths.
const REACH: f64 = 0.8;

/// Samples that a window holds at least: two more than a parabola has coefficients.
const LEAST: usize = 5;

/// Second derivative at every sample, m/s²; 0 where there are fewer than 5 samples.
pub fn of(time: &[f64], position: &[f64]) -> Vec<f64> {
    if time.len() < LEAST {
        return vec![0.0; time.len()];
    }
    time.iter().map(|t| at(*t, time, position)).collect()
}

fn at(t: f64, time: &[f64], position: &[f64]) -> f64 {
    let (first, last) = (time[0], time[time.len() - 1]);
    let mut reach = REACH;
    loop {
        let whole = last - first <= 2.0 * reach;
        let centre = if whole { 0.5 * (first + last) } else { t.clamp(first + reach, last - reach) };
        // a window over the whole record is widened a little, so that its end samples keep some weight
        let half = if whole { 0.5 * (last - first) * 1.25 } else { reach };
        let start = time.partition_point(|s| *s <= centre - half);
        let stop = time.partition_point(|s| *s < centre + half);
        if stop.saturating_sub(start) >= LEAST || whole {
            return curvature(&time[start..stop], &position[start..stop], centre, half);
        }
        reach *= 2.0;
    }
}

/// 2c/h² of the weighted parabola; 0 where the normal equations have no solution.
fn curvature(time: &[f64], position: &[f64], centre: f64, half: f64) -> f64 {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    // differences from one position keep digits where the carrier is far from the origin
    let origin = position[position.len() / 2];
    for (t, p) in time.iter().zip(position) {
        let tau = (t - centre) / half;
        let weight = (1.0 - tau * tau).powi(2);
        let powers = Vector3::new(1.0, tau, tau * tau);
        normal += weight * powers * powers.transpose();
        right += weight * (p - origin) * powers;
    }
    normal.cholesky().map_or(0.0, |factor| 2.0 * factor.solve(&right)[2] / (half * half))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a thrown stone has one acceleration, at irregular times, across a gap, in short and slow records.
    #[test]
    fn a_parabola_has_one_acceleration() {
        let jitter = |k: usize| 0.1 * k as f64 + 0.03 * (2.3 * k as f64).sin();
        let gap = |k: usize| jitter(k) + if k > 40 { 7.0 } else { 0.0 };
        let records: [Vec<f64>; 4] = [
            (0..80).map(jitter).collect(),
            (0..80).map(gap).collect(),
            (0..6).map(jitter).collect(),
            (0..30).map(|k| 2.0 * jitter(k) * 10.0).collect(),
        ];
        for time in records {
            let position: Vec<f64> = time.iter().map(|t| 300.0 + 2.0 * t - 0.5 * 9.81 * t * t).collect();
            assert!(of(&time, &position).iter().all(|a| (a + 9.81).abs() < 1e-6), "{:?}", of(&time, &position));
        }
        assert_eq!(of(&[0.0, 0.1], &[1.0, 2.0]), [0.0; 2]);
    }

    /// Oracle: the second derivative of a sine, and how much of white noise a difference of three samples would leave.
    #[test]
    fn a_slow_manoeuvre_is_followed_and_noise_is_not() {
        let time: Vec<f64> = (0..300).map(|k| 0.05 * f64::from(k)).collect();
        let sway: Vec<f64> = time.iter().map(|t| 0.5 * (0.9 * t).sin()).collect();
        let found = of(&time, &sway);
        for (t, a) in time.iter().zip(&found).skip(16).take(268) {
            assert!((a + 0.5 * 0.81 * (0.9 * t).sin()).abs() < 0.02, "{a} at {t} s");
        }
        let noise: Vec<f64> = (0..300u64).map(|k| (k * 2_654_435_761 % 1000) as f64 * 1e-6 - 5e-4).collect();
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
        let differences: Vec<f64> = noise.windows(3).map(|p| (p[0] - 2.0 * p[1] + p[2]) / 0.0025).collect();
        assert!(rms(&of(&time, &noise)) < 0.02 * rms(&differences));
    }
}
