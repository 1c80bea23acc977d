//! Linear least squares: minimise ‖X c − y‖² for each column of y.
//!
//! Columns of X are scaled to unit norm first, so that a pressure in pascal cubed stands beside a
//! constant without loss. Directions that X does not determine get the smallest coefficients.

use nalgebra::DMatrix;

/// Singular values below this fraction of the largest are rounding.
const RANK: f64 = 1e-13;

/// Coefficients and what is needed for their standard deviations.
pub(crate) struct Solution {
    /// One row per column of X, one column per column of y.
    pub coefficients: DMatrix<f64>,
    /// Diagonal of (XᵀX)⁻¹; NaN where X does not determine the coefficient.
    pub variance: Vec<f64>,
}

/// Solves for all columns of `y` at once.
pub(crate) fn solve(x: &DMatrix<f64>, y: &DMatrix<f64>) -> Solution {
    let scale: Vec<f64> = x.column_iter().map(|c| positive(c.norm())).collect();
    let mut scaled = x.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scale) {
        column /= *scale;
    }
    // QR first, so that the singular value decomposition is small.
    let qr = scaled.qr();
    let mut right = y.clone();
    qr.q_tr_mul(&mut right);
    let triangle = qr.unpack_r();
    let right = right.rows(0, triangle.nrows()).into_owned();
    let mut solution = invert(triangle, &right);
    for (j, scale) in scale.iter().enumerate() {
        solution.coefficients.row_mut(j).unscale_mut(*scale);
        solution.variance[j] /= scale * scale;
    }
    solution
}

fn positive(norm: f64) -> f64 {
    if norm > 0.0 { norm } else { 1.0 }
}

fn invert(triangle: DMatrix<f64>, right: &DMatrix<f64>) -> Solution {
    let columns = triangle.ncols();
    let svd = triangle.svd(true, true);
    let cut = RANK * svd.singular_values.iter().copied().fold(0.0, f64::max);
    let empty = || DMatrix::zeros(0, columns);
    let u = svd.u.unwrap_or_else(empty);
    let v = svd.v_t.unwrap_or_else(empty).transpose();
    let inverse = svd.singular_values.map(|s| if s > cut { 1.0 / s } else { 0.0 });
    let coefficients = &v * DMatrix::from_diagonal(&inverse) * u.tr_mul(right);
    let variance = (0..columns).map(|j| variance(&v, inverse.as_slice(), j));
    Solution { coefficients, variance: variance.collect() }
}

fn variance(v: &DMatrix<f64>, inverse: &[f64], j: usize) -> f64 {
    let (mut seen, mut sum) = (0.0, 0.0);
    for (k, inverse) in inverse.iter().enumerate().filter(|(_, inverse)| **inverse > 0.0) {
        seen += v[(j, k)].powi(2);
        sum += (v[(j, k)] * inverse).powi(2);
    }
    if seen > 1.0 - 1e-6 { sum } else { f64::NAN }
}
