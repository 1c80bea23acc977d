//! The offset below one sample, with an interval: weighted least squares on band-limited rates.
//!
//! ```text
//! r(t_i) = (a_0 + a_1·z + a_2·z²)·s(u_i) + ε_i,      u_i = u_0 + (t_i − o − u_0)/(1 + d)
//! ```
//!
//! | symbol | meaning | unit |
//! | `r`, `s` | rates of reference and source, see [`super::slope`] | 1/s |
//! | `z` | standardised value of the source: a quasi-static plant is y = f(x), and ẏ = f'(x)·ẋ | 1 |
//! | `o`, `d` | offset at source time `u_0`, drift | s, 1 |
//!
//! Gauss–Newton over (o, d, a), Huber's weights. Residuals of smoothed rates are no white noise: the covariance is that of
//! leaving out one of B blocks of time after the other, each to first order,
//!
//! ```text
//! V = (B − 1)/B·Σ_b δ_b·δ_bᵀ,     δ_b = (A − A_b)⁻¹·g_b,     g_b = Σ_{i in b} J_iᵀ·w_i·ε_i,     A_b = −∂g_b/∂(o, d, a)
//! ```
//!
//! with A from differences and not JᵀWJ: the source's own noise moves with o, and would pass for curvature. Half of an
//! interval is Student's quantile with B − p degrees of freedom times √V. Sources: Huber 1981, *Robust Statistics*, ch. 7; Shao and Tu
//! 1995, *The Jackknife and Bootstrap*, ch. 9 (blocks).

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::slope::local;
use crate::join::series::{Series, median};

/// Steps of Gauss and Newton.
const STEPS: usize = 60;

/// Blocks of time, at most and at least.
const BLOCKS: (usize, usize) = (24, 6);

/// Times that are compared, at most.
const POINTS: f64 = 65536.0;

/// Terms of the gain's polynomial.
const GAINS: usize = 3;

/// The compared items.
pub struct Pair<'a> {
    /// Series of the reference.
    pub reference: &'a Series,
    /// Series of the source.
    pub source: &'a Series,
    /// Half of the width of the window of rates, s.
    pub width: f64,
}

/// Result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refined {
    /// Offset at the source time `origin`, s, and half of its 95 % interval.
    pub offset: f64,
    /// Half of its 95 % interval, s.
    pub interval: f64,
    /// Relative rate of the clocks less one, 1.
    pub drift: f64,
    /// Half of its 95 % interval, 1.
    pub drift_interval: f64,
    /// Share of the reference's rate that the source explains, 1.
    pub explained: f64,
}

/// One evaluation: what is explained, and by what.
struct Model {
    /// Residuals `[N]`, 1/s.
    residuals: Vec<f64>,
    /// Derivatives `[N×p]` of what is explained.
    jacobian: DMatrix<f64>,
    times: Vec<f64>,
    rates: Vec<f64>,
}

/// Improves `offset`, and the drift where it is `free`; `origin` is the source time at which the offset holds.
pub fn refine(pair: &Pair, offset: f64, drift: f64, free: bool, origin: f64) -> Option<Refined> {
    let times = grid(pair, offset, drift, origin);
    let at = |all: &[f64]| pair.model(&times, all, drift, origin);
    let mut found = [[0.0; GAINS].as_slice(), &[offset]].concat();
    found.extend(free.then_some(drift));
    for step in 0..STEPS {
        let model = at(&found)?;
        let (h, g) = normal(&model, &huber(&model.residuals));
        let change = h.cholesky()?.solve(&g);
        let limits = [f64::INFINITY, f64::INFINITY, f64::INFINITY, pair.width, 1e-3];
        found.iter_mut().zip(change.iter()).zip(limits).for_each(|((x, step), most)| *x += step.clamp(-most, most));
        if change[GAINS].abs() < 1e-7 && step > 0 {
            break;
        }
    }
    let drift = found.get(GAINS + 1).copied().unwrap_or(drift);
    if !(drift.abs() < 0.05) {
        return None;
    }
    let model = at(&found)?;
    let blocks = (times.len() / 10).clamp(BLOCKS.1, BLOCKS.0).max(found.len() + 2);
    let variance = jackknife(&at, &found, pair.width, blocks)?;
    let quantile = student((blocks - found.len()) as f64);
    let half = |k: usize| quantile * variance[(k, k)].max(0.0).sqrt();
    let all: f64 = model.rates.iter().map(|rate| rate * rate).sum();
    let left: f64 = model.residuals.iter().map(|residual| residual * residual).sum();
    let drift_interval = if free { half(GAINS + 1) } else { 0.0 };
    let (interval, explained) = (half(GAINS), 1.0 - left / all);
    Some(Refined { offset: found[GAINS], interval, drift, drift_interval, explained })
}

/// Reference times at half the width of the window, or [`POINTS`] of them, as far as both sources reach.
pub fn grid(pair: &Pair, offset: f64, drift: f64, origin: f64) -> Vec<f64> {
    let (Some(r), Some(s)) = (pair.reference.span(), pair.source.span()) else { return Vec::new() };
    let forward = |u: f64| u + offset + drift * (u - origin);
    // a window's width within the ends, so that a changed offset leaves no sample without a window
    let (from, to) = (r.0.max(forward(s.0)) + 2.0 * pair.width, r.1.min(forward(s.1)) - 2.0 * pair.width);
    let step = (0.5 * pair.width).max((to - from) / POINTS);
    let count = ((to - from) / step).floor().max(0.0) as usize;
    (0..count).map(|k| from + step * k as f64).collect()
}

/// Mean and standard deviation of the values.
pub fn standard(series: &Series) -> (f64, f64) {
    let count = series.values.len().max(1) as f64;
    let mean = series.values.iter().sum::<f64>() / count;
    let variance = series.values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt().max(f64::MIN_POSITIVE))
}

impl Pair<'_> {
    /// The model with these gains, this offset and, as the last, the drift where it is free.
    fn model(&self, times: &[f64], found: &[f64], drift: f64, origin: f64) -> Option<Model> {
        let (center, scale) = standard(self.source);
        let basis = |u: f64| -> Option<[f64; GAINS]> {
            let (value, rate) = local(self.source, u, self.width)?;
            let z = (value - center) / scale;
            Some([rate, z * rate, z * z * rate])
        };
        let (h, columns, o) = (0.25 * self.width, found.len(), found[GAINS]);
        let d = found.get(GAINS + 1).copied().unwrap_or(drift);
        let dot = |basis: &[f64; GAINS]| basis.iter().zip(found).map(|(b, a)| b * a).sum::<f64>();
        let (mut rows, mut residuals, mut kept, mut rates) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for t in times {
            let u = origin + (t - o - origin) / (1.0 + d);
            let (Some((_, rate)), Some(here), Some(before), Some(after)) =
                (local(self.reference, *t, self.width), basis(u), basis(u - h), basis(u + h))
            else {
                continue;
            };
            let slope = (dot(&after) - dot(&before)) / (2.0 * h);
            rows.extend(here);
            rows.extend([-slope, -slope * (u - origin)].into_iter().take(columns - GAINS));
            residuals.push(rate - dot(&here));
            rates.push(rate);
            kept.push(*t);
        }
        let enough = kept.len() >= 4 * columns && kept.len() * 3 >= times.len();
        let jacobian = DMatrix::from_row_slice(kept.len(), columns, &rows);
        enough.then_some(Model { residuals, jacobian, times: kept, rates })
    }
}

/// Weights that bound what a single residual can do.
fn huber(residuals: &[f64]) -> Vec<f64> {
    let sizes: Vec<f64> = residuals.iter().map(|residual| residual.abs()).collect();
    let bound = (2.5 * 1.4826 * median(&sizes)).max(f64::MIN_POSITIVE);
    sizes.iter().map(|size| (bound / size.max(bound)).min(1.0)).collect()
}

/// `(Jᵀ·W·J, Jᵀ·W·ε)`, with a trace of ridge where the gain is not yet known.
fn normal(model: &Model, weights: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let p = model.jacobian.ncols();
    let (mut h, mut g) = (DMatrix::zeros(p, p), DVector::zeros(p));
    for (i, row) in model.jacobian.row_iter().enumerate() {
        h += row.transpose() * row * weights[i];
        g += row.transpose() * (weights[i] * model.residuals[i]);
    }
    let largest = (0..p).map(|k| h[(k, k)]).fold(0.0, f64::max);
    (0..p).for_each(|k| h[(k, k)] += h[(k, k)].max(1e-12 * largest) * 1e-12 + f64::MIN_POSITIVE);
    (h, g)
}

/// Sums over the blocks of time of `Jᵀ·w·ε`.
fn gradients(model: &Model, weights: &BTreeMap<u64, f64>, span: (f64, f64), blocks: usize) -> Vec<DVector<f64>> {
    let mut sums = vec![DVector::zeros(model.jacobian.ncols()); blocks];
    for (i, row) in model.jacobian.row_iter().enumerate() {
        let block = ((model.times[i] - span.0) / (span.1 - span.0) * blocks as f64) as usize;
        let weight = weights.get(&model.times[i].to_bits()).copied().unwrap_or(1.0);
        sums[block.min(blocks - 1)] += row.transpose() * (weight * model.residuals[i]);
    }
    sums
}

/// Covariance of what is fitted, by leaving out one block of time after the other.
fn jackknife(at: &dyn Fn(&[f64]) -> Option<Model>, found: &[f64], width: f64, blocks: usize) -> Option<DMatrix<f64>> {
    let model = at(found)?;
    let span = (*model.times.first()?, *model.times.last()?);
    let weights = model.times.iter().map(|t| t.to_bits()).zip(huber(&model.residuals)).collect();
    let here = gradients(&model, &weights, span, blocks);
    let p = found.len();
    let mut curvature = vec![DMatrix::zeros(p, p); blocks];
    for k in 0..p {
        let h = match k {
            GAINS => 0.1 * width,
            k if k > GAINS => 0.1 * width / (span.1 - span.0),
            k => 1e-3 * found[k].abs().max(1e-3),
        };
        let moved = |h: f64| at(&(0..p).map(|j| found[j] + if j == k { h } else { 0.0 }).collect::<Vec<_>>());
        let [before, after] =
            [gradients(&moved(-h)?, &weights, span, blocks), gradients(&moved(h)?, &weights, span, blocks)];
        for (block, matrix) in curvature.iter_mut().enumerate() {
            matrix.set_column(k, &((&before[block] - &after[block]) / (2.0 * h)));
        }
    }
    let whole: DMatrix<f64> = curvature.iter().sum();
    let mut all = DMatrix::zeros(p, p);
    for (of_block, gradient) in curvature.iter().zip(&here) {
        let change = (&whole - of_block).lu().solve(gradient)?;
        all += &change * change.transpose();
    }
    Some(all * ((blocks - 1) as f64 / blocks as f64))
}

/// Student's 97.5 % quantile, to a percent for two degrees of freedom and better for more: Cornish and Fisher's expansion.
fn student(freedom: f64) -> f64 {
    let z = 1.959964f64;
    let first = (z.powi(3) + z) / (4.0 * freedom);
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * freedom.powi(2));
    let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / (384.0 * freedom.powi(3));
    z + first + second + third
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: tables of Student's distribution.
    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, table) in [(3.0, 3.182), (6.0, 2.447), (10.0, 2.228), (20.0, 2.086)] {
            assert!((student(freedom) / table - 1.0).abs() < 0.02, "{freedom}: {}", student(freedom));
        }
    }

    /// Oracle: planted, without noise.
    #[test]
    fn without_noise_offset_and_drift_are_exact() {
        let x = |t: f64| (1.3 * t).sin() + 0.6 * (0.37 * t + 0.2).sin();
        let clock = |t: f64| 5.0 + (t - 5.0 - 0.7) / (1.0 + 8e-5);
        let source = Series::new(&grid_of(4000), &grid_of(4000).iter().map(|u| x(*u)).collect::<Vec<_>>());
        let times: Vec<f64> = (700..3500).map(|k| f64::from(k) * 0.011).collect();
        let reference = Series::new(&times, &times.iter().map(|t| 2.0 * x(clock(*t))).collect::<Vec<_>>());
        let pair = Pair { reference: &reference, source: &source, width: 0.08 };
        let found = refine(&pair, 0.68, 0.0, true, 5.0).expect("found");
        assert!((found.offset - 0.7).abs() < 2e-5 && (found.drift - 8e-5).abs() < 1e-6, "{found:?}");
        assert!(found.explained > 0.9999, "{found:?}");
    }

    fn grid_of(count: u32) -> Vec<f64> {
        (0..count).map(|k| f64::from(k) * 0.01).collect()
    }
}
