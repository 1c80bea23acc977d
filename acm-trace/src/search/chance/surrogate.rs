//! Surrogates for the largest gain of any candidate where no effect acts: residuals with random phases.
//!
//! ```text
//! y* = fit of the smaller model + e*,   |ê*(f)| = |ê(f)|, phases uniform and the same for all outputs
//! q  = mean − 0.5772 b − b ln(−ln(1 − α)),   b = √6 s / π
//! ```
//!
//! | symbol | meaning                                              | unit |
//! | `e`    | residual of the larger model                         | weighted |
//! | `q`    | quantile of the largest gain of any candidate        | 1    |
//! | `s`    | standard deviation of the largest gain over surrogates | 1  |
//!
//! Theiler et al. (1992), Physica D 58; Gumbel (1958), Statistics of Extremes, for the tail of a maximum.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use realfft::RealFftPlanner;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Returns the residuals of trials that end at `edges`, `[n × r]`, with their phases drawn at random.
pub fn randomised(residual: &DMatrix<f64>, edges: &[usize], random: &mut ChaCha8Rng) -> DMatrix<f64> {
    let mut out = residual.clone();
    let mut planner = RealFftPlanner::<f64>::new();
    for trial in edges.windows(2) {
        let n = trial[1] - trial[0];
        if n < 4 {
            continue;
        }
        let (forward, inverse) = (planner.plan_fft_forward(n), planner.plan_fft_inverse(n));
        let phases: Vec<f64> = (0..=n / 2).map(|_| random.random_range(0.0..TAU)).collect();
        let sign = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        for o in 0..residual.ncols() {
            let column: DVector<f64> = residual.column(o).rows(trial[0], n).into_owned();
            let mean = column.mean();
            let mut time: Vec<f64> = column.iter().map(|e| e - mean).collect();
            let before = time.iter().map(|e| e * e).sum::<f64>();
            let mut spectrum = forward.make_output_vec();
            if forward.process(&mut time, &mut spectrum).is_err() {
                continue;
            }
            let last = spectrum.len() - 1;
            for (k, (value, phase)) in spectrum.iter_mut().zip(&phases).enumerate() {
                let real = k == 0 || (k == last && n % 2 == 0);
                *value = if real {
                    *value * phase.cos().signum()
                } else {
                    *value * realfft::num_complex::Complex::from_polar(1.0, *phase)
                };
            }
            if inverse.process(&mut spectrum, &mut time).is_err() {
                continue;
            }
            let after = time.iter().map(|e| e * e).sum::<f64>();
            let scale = if after > 0.0 { (before / after).sqrt() } else { 0.0 };
            out.column_mut(o)
                .rows_mut(trial[0], n)
                .iter_mut()
                .zip(&time)
                .for_each(|(out, e)| *out = e * scale + sign * mean);
        }
    }
    out
}

/// Returns `count` surrogates side by side.
pub fn sets(residual: &DMatrix<f64>, edges: &[usize], count: usize, seed: u64) -> DMatrix<f64> {
    let (n, r) = residual.shape();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut all = DMatrix::zeros(n, r * count);
    for set in 0..count {
        all.columns_mut(set * r, r).copy_from(&randomised(residual, edges, &mut random));
    }
    all
}

/// Returns q: the quantile 1 − α of the maximum, from some draws of it.
pub fn quantile_of_maximum(draws: &[f64], alpha: f64) -> f64 {
    let n = draws.len() as f64;
    let mean = draws.iter().sum::<f64>() / n;
    let variance = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    let b = (6.0 * variance).sqrt() / PI;
    mean - EULER * b - b * (-(1.0 - alpha).ln()).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the periodogram of a surrogate is that of the residual, by sums written out.
    #[test]
    fn spectra_stay_and_phases_do_not() {
        let e = DMatrix::from_fn(40, 2, |t, o| ((t * (o + 2)) as f64 * 0.7).sin() + 0.2 * t as f64 * (1 - o) as f64);
        let surrogate = randomised(&e, &[0, 40], &mut ChaCha8Rng::seed_from_u64(3));
        let power = |x: &DMatrix<f64>, o: usize, k: usize| {
            let part = |f: fn(f64) -> f64| (0..40).map(|t| x[(t, o)] * f(TAU * (k * t) as f64 / 40.0)).sum::<f64>();
            part(f64::cos).hypot(part(f64::sin))
        };
        for (o, k) in [(0, 1), (0, 7), (1, 4), (1, 19)] {
            assert!((power(&e, o, k) - power(&surrogate, o, k)).abs() < 1e-9);
        }
        assert!((&e - &surrogate).norm() > 0.5 * e.norm());
        assert_eq!(surrogate, randomised(&e, &[0, 40], &mut ChaCha8Rng::seed_from_u64(3)));
    }

    /// Oracle: the largest of many exponential variables is Gumbel; its quantile in closed form.
    #[test]
    fn the_quantile_of_a_gumbel_variable() {
        let draws: Vec<f64> = (0..4000).map(|k| -(-((f64::from(k) + 0.5) / 4000.0).ln()).ln()).collect();
        let truth = -(-(0.99f64).ln()).ln();
        assert!((quantile_of_maximum(&draws, 0.01) / truth - 1.0).abs() < 0.02);
    }
}
