//! Least squares problems over many samples, and their reduction to a small triangle.
//!
//! ```text
//! [J | r] = Q·[R z; 0 ρ],   ‖r + J p‖² = ‖z + R p‖² + ρ²
//! ```
//!
//! | symbol | meaning                                    | shape  |
//! | `r`    | residuals of all samples                   | T·O    |
//! | `J`    | their slopes with respect to the parameters | T·O × n |
//! | `R, z` | what is left of J and r                    | n × n, n |
//!
//! Chunks of samples are reduced by Householder reflections in parallel, and the small triangles are merged
//! in the order of the chunks, so that no bit depends on the number of threads. No normal equations are
//! formed: the condition of J is not squared. Demmel et al. (2012), SIAM J. Sci. Comput. 34(1) (TSQR).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fitting::triangle;

/// Samples that one task works on.
const CHUNK: usize = 512;

/// Residuals that depend on parameters, sample by sample.
pub trait Residuals: Sync {
    /// Number of parameters n.
    fn parameters(&self) -> usize;

    /// Number of samples T.
    fn samples(&self) -> usize;

    /// Residuals per sample O.
    fn outputs(&self) -> usize;

    /// Residuals of the samples in `range` into `out`, O for each sample.
    fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]);

    /// Residuals into `out`, and their slopes into the rows of `slopes` (rows as in `out`, n columns). Their order is free.
    fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>);

    /// Number of residuals in all.
    fn rows(&self) -> usize {
        self.samples() * self.outputs()
    }
}

/// A problem at one point, reduced: see the header.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// R, n × n.
    pub triangle: DMatrix<f64>,
    /// z, n.
    pub right: DVector<f64>,
    /// ‖r‖².
    pub cost: f64,
}

/// ‖r‖² at `theta`.
pub fn cost(problem: &impl Residuals, theta: &[f64]) -> f64 {
    let parts: Vec<f64> = chunks(problem.samples())
        .into_par_iter()
        .map(|range| {
            let mut out = vec![0.0; range.len() * problem.outputs()];
            problem.residuals(theta, range, &mut out);
            out.iter().map(|r| r * r).sum()
        })
        .collect();
    parts.iter().sum()
}

/// Residuals and slopes at `theta`, reduced.
pub fn reduce(problem: &impl Residuals, theta: &[f64]) -> Reduced {
    let parts: Vec<(f64, DMatrix<f64>)> =
        chunks(problem.samples()).into_par_iter().map(|range| reduce_chunk(problem, theta, range)).collect();
    let cost = parts.iter().map(|(cost, _)| cost).sum();
    let n = problem.parameters();
    let mut merged = DMatrix::zeros(n + 1, n + 1);
    parts.into_iter().for_each(|(_, mut part)| triangle::absorb(&mut merged, &mut part));
    Reduced {
        triangle: merged.view((0, 0), (n, n)).into_owned(),
        right: merged.view((0, n), (n, 1)).column(0).into_owned(),
        cost,
    }
}

fn chunks(samples: usize) -> Vec<Range<usize>> {
    (0..samples).step_by(CHUNK).map(|start| start..(start + CHUNK).min(samples)).collect()
}

fn reduce_chunk(problem: &impl Residuals, theta: &[f64], range: Range<usize>) -> (f64, DMatrix<f64>) {
    let (rows, n) = (range.len() * problem.outputs(), problem.parameters());
    let mut out = vec![0.0; rows];
    let mut slopes = DMatrix::zeros(rows, n);
    problem.slopes(theta, range, &mut out, &mut slopes);
    let cost = out.iter().map(|r| r * r).sum();
    let mut both = slopes.insert_column(n, 0.0);
    both.column_mut(n).copy_from_slice(&out);
    let mut reduced = DMatrix::zeros(n + 1, n + 1);
    triangle::absorb(&mut reduced, &mut both);
    (cost, reduced)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight line through points that no line passes: slope and intercept.
    struct Line(usize);

    impl Residuals for Line {
        fn parameters(&self) -> usize {
            2
        }
        fn samples(&self) -> usize {
            self.0
        }
        fn outputs(&self) -> usize {
            1
        }
        fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]) {
            for (k, out) in range.zip(out) {
                let x = k as f64;
                *out = theta[0] * x + theta[1] - (x * 0.37).sin();
            }
        }
        fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
            self.residuals(theta, range.clone(), out);
            for (row, k) in range.enumerate() {
                slopes[(row, 0)] = k as f64;
                slopes[(row, 1)] = 1.0;
            }
        }
    }

    /// Oracle: JᵀJ, Jᵀr and rᵀr summed directly; one sample, one chunk, several chunks.
    #[test]
    fn the_triangle_keeps_the_normal_equations() {
        for samples in [1, 100, 1000] {
            let line = Line(samples);
            let theta = [0.2, -0.5];
            let (mut out, mut j) = (vec![0.0; samples], DMatrix::zeros(samples, 2));
            line.slopes(&theta, 0..samples, &mut out, &mut j);
            let r = DVector::from_vec(out);
            let reduced = reduce(&line, &theta);
            let (normal, right) = (j.transpose() * &j, j.transpose() * &r);
            let mine = reduced.triangle.transpose() * &reduced.triangle;
            assert!((mine - &normal).amax() <= 1e-12 * normal.amax());
            let mine = reduced.triangle.transpose() * &reduced.right;
            assert!((mine - &right).amax() <= 1e-12 * right.amax().max(1.0));
            assert!((reduced.cost - r.norm_squared()).abs() <= 1e-12 * reduced.cost);
            assert!((cost(&line, &theta) - reduced.cost).abs() <= 1e-12 * reduced.cost);
        }
    }
}
