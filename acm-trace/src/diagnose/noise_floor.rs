//! White noise of a signal, from each sample's deviation from the line through its neighbours.
//!
//! ```text
//! e_k = y_k − (w₁ y_{k−1} + w₂ y_{k+1}),   w₁ = (t_{k+1} − t_k)/(t_{k+1} − t_{k−1}),   w₂ = 1 − w₁
//! σ²  = mean of s²(e_k / √(1 + w₁² + w₂²)) over stretches,   floor = √Σ_m σ_m²
//! s²:   mean of min(e², c² s²) = β s²,   β = E[min(z², c²)] for normal z
//! ```
//!
//! | symbol | meaning                                                        | unit          |
//! | `y`    | residual, or a measured output                                 | of the output |
//! | `e`    | second difference on time stamps as they are                   | of the output |
//! | `s`    | Huber's scale of one stretch, unmoved by a spike or a slip     | of the output |
//! | `c, β` | 1.5, 0.7785                                                    | 1             |
//!
//! An upper bound of white noise: curvature within two steps counts as noise. Of coloured noise (from a filter in the motion capture) only
//! the white part is seen. Scales are averaged over stretches, so that noise of varying level keeps its mean square. Huber (1981), Robust
//! Statistics, § 5.2 (proposal 2); Gasser, Sroka & Jennen-Steinmetz (1986), Biometrika 73(3).

use rayon::prelude::*;

use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{counted, median, median_step};

/// Longest gap, in median steps, over which neighbours are compared.
const GAP: f64 = 3.0;

/// Number of differences in one stretch.
const STRETCH: usize = 128;

/// Limit in standard deviations beyond which a difference counts no more than at the limit.
const CLIP: f64 = 1.5;

/// Expected value E[min(z², CLIP²)] for normal z.
const CLIPPED_VARIANCE: f64 = 0.778_465_216;

/// Returns the root mean square of the white part of the residual, over all outputs together; 0 where no three samples
/// are neighbours.
pub fn noise_floor(remainder: &Remainder) -> f64 {
    let outputs = remainder.outputs();
    let step = median_step(remainder.trials.iter().map(|trial| trial.record.time.as_slice()));
    let parts: Vec<Vec<Variance>> = remainder
        .trials
        .par_iter()
        .map(|trial| {
            let rows = counted(trial, outputs);
            let time: Vec<f64> = rows.iter().map(|&t| trial.record.time[t]).collect();
            let column = |m: usize| rows.iter().map(|&t| trial.residual[t * outputs + m]).collect::<Vec<f64>>();
            (0..outputs).map(|m| variance(&differences(&time, &column(m), step))).collect()
        })
        .collect();
    let of = |m: usize| parts.iter().map(|trial| trial[m]).fold(Variance::default(), Variance::and).mean();
    (0..outputs).map(of).sum::<f64>().sqrt()
}

/// Estimates the noise floor of the measured `outputs` of one trial (M columns over `time`, NaN where nothing was measured). At the full
/// rate of a recording, motion has less curvature within two steps than in the decimated one.
pub fn noise_floor_of(time: &[f64], outputs: &[Vec<f64>]) -> f64 {
    let step = median_step([time]);
    let of = |values: &Vec<f64>| {
        let (time, values): (Vec<f64>, Vec<f64>) =
            time.iter().zip(values).filter(|(_, value)| value.is_finite()).unzip();
        variance(&differences(&time, &values, step)).mean()
    };
    outputs.iter().map(of).sum::<f64>().sqrt()
}

/// A sum of squares and its count.
#[derive(Debug, Clone, Copy, Default)]
struct Variance {
    sum: f64,
    count: usize,
}

impl Variance {
    fn and(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, count: self.count + other.count }
    }

    fn mean(self) -> f64 {
        if self.count > 0 { self.sum / self.count as f64 } else { 0.0 }
    }
}

/// Returns e / √(1 + w₁² + w₂²) of all neighbours without a gap between them.
fn differences(time: &[f64], values: &[f64], step: f64) -> Vec<f64> {
    let near = |pair: &[f64]| pair[1] > pair[0] && pair[1] - pair[0] <= GAP * step;
    time.windows(3)
        .zip(values.windows(3))
        .filter(|(t, _)| near(&t[..2]) && near(&t[1..]))
        .map(|(t, y)| {
            let before = (t[2] - t[1]) / (t[2] - t[0]);
            let after = 1.0 - before;
            (y[1] - before * y[0] - after * y[2]) / (1.0 + before * before + after * after).sqrt()
        })
        .collect()
}

fn variance(differences: &[f64]) -> Variance {
    let count = differences.len();
    let stretches = (count / STRETCH).max(1);
    let of = |k: usize| {
        let stretch = &differences[k * count / stretches..(k + 1) * count / stretches];
        huber_variance(stretch) * stretch.len() as f64
    };
    Variance { sum: (0..stretches).map(of).sum(), count }
}

/// Computes s² of the header, by fixed-point steps.
fn huber_variance(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let squares: Vec<f64> = values.iter().map(|e| e * e).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    let mut variance = match median(&mut squares.clone()) / 0.455 {
        from_median if from_median > 0.0 => from_median.min(mean),
        _ => mean,
    };
    for _ in 0..100 {
        let clip = CLIP * CLIP * variance;
        let clipped = squares.iter().map(|e| e.min(clip)).sum::<f64>() / squares.len() as f64;
        let next = clipped / CLIPPED_VARIANCE;
        let settled = (next - variance).abs() <= 1e-10 * variance;
        variance = next;
        if settled || variance == 0.0 {
            break;
        }
    }
    variance
}
