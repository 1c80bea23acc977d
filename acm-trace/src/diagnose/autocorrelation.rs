//! Autocorrelation of the residual, on irregular time stamps.
//!
//! ```text
//! ρ_m(ℓ) = mean of e_m(t_i) e_m(t_j) over pairs with |t_j − t_i − ℓ| < h/2,  divided by the mean of e_m²
//! ρ(ℓ)   = mean of ρ_m over outputs,   e_m = r_m − mean over all trials
//! white  = 1.96/√N_eff,   N_eff = N · M² / Σ_mn c_mn²
//! ```
//!
//! | symbol | meaning                                                     | unit |
//! | `h`    | median time between samples                                 | s    |
//! | `ℓ`    | lag, a multiple of h, up to 10 s or a quarter of a trial    | s    |
//! | `c`    | correlation of outputs with each other                      | 1    |
//!
//! The mean is that of all trials, so that the offset of one trial is seen: it keeps ρ up at long lags. Pairs never
//! cross from one trial to the next. Bartlett (1946), Suppl. J. R. Stat. Soc. 8(1); Rehfeld et al. (2011), Nonlin.
//! Processes Geophys. 18 (irregular sampling).

use rayon::prelude::*;

use crate::diagnose::remainder::{Remainder, TrialRemainder};
use crate::diagnose::samples::{counted, median, median_step, residuals, samples};
use crate::finding::Autocorrelation;

/// Longest lag, s.
const LONGEST: f64 = 10.0;

/// Largest number of lags, for a figure.
const MOST_LAGS: usize = 200;

/// Smallest number of pairs that a correlation is computed from.
const FEWEST_PAIRS: usize = 10;

/// Computes the autocorrelation of `before` and `after` at the same lags.
pub fn autocorrelation(before: &Remainder, after: &Remainder) -> Autocorrelation {
    let step = median_step(after.trials.iter().map(|trial| trial.record.time.as_slice()));
    let lags = lags(after, step);
    let (first, second) = (correlations(before, &lags, step), correlations(after, &lags, step));
    let kept = first.iter().zip(&second).take_while(|(a, b)| a.is_some() && b.is_some()).count();
    let values = |found: Vec<Option<f64>>| found.into_iter().take(kept).flatten().collect();
    Autocorrelation { lag: lags[..kept].to_vec(), before: values(first), after: values(second), white: white(after) }
}

/// Returns lags that are multiples of the median step.
fn lags(remainder: &Remainder, step: f64) -> Vec<f64> {
    let length = |trial: &TrialRemainder| match trial.record.time.as_slice() {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    let mut lengths: Vec<f64> = remainder.trials.iter().map(length).collect();
    let longest = LONGEST.min(0.25 * median(&mut lengths));
    let count = if step > 0.0 { (longest / step).floor() as usize } else { 0 };
    let stride = count.div_ceil(MOST_LAGS).max(1);
    (1..=count).step_by(stride).map(|k| k as f64 * step).collect()
}

fn correlations(remainder: &Remainder, lags: &[f64], step: f64) -> Vec<Option<f64>> {
    let outputs = remainder.outputs();
    let (mean, square) = per_output(remainder);
    let trials: Vec<(Vec<f64>, Vec<f64>)> = remainder.trials.iter().map(|trial| centred(trial, &mean)).collect();
    lags.par_iter()
        .map(|&lag| {
            let (mut sums, mut pairs) = (vec![0.0; outputs], 0);
            for (time, values) in &trials {
                pairs += products(time, values, lag, 0.5 * step, &mut sums);
            }
            let of = |m: usize| sums[m] / pairs as f64 / square[m];
            let moving: Vec<f64> = (0..outputs).filter(|&m| square[m] > 0.0).map(of).collect();
            let enough = pairs >= FEWEST_PAIRS && !moving.is_empty();
            enough.then(|| moving.iter().sum::<f64>() / moving.len() as f64)
        })
        .collect()
}

/// Returns the mean and mean square about it, of each output.
fn per_output(remainder: &Remainder) -> (Vec<f64>, Vec<f64>) {
    let outputs = remainder.outputs();
    let all = residuals(remainder, &samples(remainder, usize::MAX));
    let count = (all.len() / outputs.max(1)).max(1) as f64;
    let over =
        |m: usize, of: &dyn Fn(f64) -> f64| all.iter().skip(m).step_by(outputs).map(|&r| of(r)).sum::<f64>() / count;
    let mean: Vec<f64> = (0..outputs).map(|m| over(m, &|r| r)).collect();
    let square = (0..outputs).map(|m| over(m, &|r| (r - mean[m]).powi(2))).collect();
    (mean, square)
}

/// Returns the time and residual, less `mean`, of the samples that count.
fn centred(trial: &TrialRemainder, mean: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let rows = counted(trial, mean.len());
    let row =
        |&t: &usize| trial.residual[t * mean.len()..(t + 1) * mean.len()].iter().zip(mean).map(|(r, mean)| r - mean);
    (rows.iter().map(|&t| trial.record.time[t]).collect(), rows.iter().flat_map(row).collect())
}

/// Adds the products of all pairs at `lag` to `sums`, one for each output, and returns how many pairs there were.
fn products(time: &[f64], values: &[f64], lag: f64, within: f64, sums: &mut [f64]) -> usize {
    let outputs = sums.len();
    let (mut pairs, mut j) = (0, 0);
    for i in 0..time.len() {
        let then = time[i] + lag;
        while j + 1 < time.len() && (time[j + 1] - then).abs() <= (time[j] - then).abs() {
            j += 1;
        }
        if j > i && (time[j] - then).abs() < within {
            let rows = values[i * outputs..(i + 1) * outputs].iter().zip(&values[j * outputs..(j + 1) * outputs]);
            for (sum, (a, b)) in sums.iter_mut().zip(rows) {
                *sum += a * b;
            }
            pairs += 1;
        }
    }
    pairs
}

/// Returns the bound within which white noise stays in 95 % of lags; correlated outputs count as fewer.
fn white(remainder: &Remainder) -> f64 {
    let outputs = remainder.outputs();
    let (mean, square) = per_output(remainder);
    let all = residuals(remainder, &samples(remainder, usize::MAX));
    let count = all.len() / outputs.max(1);
    let moving: Vec<usize> = (0..outputs).filter(|&m| square[m] > 0.0).collect();
    if count == 0 || moving.is_empty() {
        return 0.0;
    }
    let correlation = |m: usize, n: usize| {
        let joint: f64 = all.chunks_exact(outputs).map(|row| (row[m] - mean[m]) * (row[n] - mean[n])).sum();
        joint / count as f64 / (square[m] * square[n]).sqrt()
    };
    let pairs = moving.iter().flat_map(|&m| moving.iter().map(move |&n| (m, n)));
    let together: f64 = pairs.map(|(m, n)| correlation(m, n).powi(2)).sum();
    1.96 / (count as f64 * (moving.len() as f64).powi(2) / together).sqrt()
}
