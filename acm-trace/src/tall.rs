//! Products AᵀB of matrices with many rows and few columns.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView};

/// Fewest columns of a product in tiles of registers; narrower ones take one pair of columns after the other.
pub(crate) const TILE: usize = 6;

/// Computes AᵀB over some rows.
pub(crate) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>, rows: Range<usize>) -> DMatrix<f64> {
    let (first, count) = (rows.start, rows.len());
    if a.ncols() < TILE || b.ncols() < TILE || count < TILE {
        return a.rows(first, count).tr_mul(&b.rows(first, count));
    }
    // The same memory with rows and columns exchanged.
    let turned = DMatrixView::from_slice_with_strides(&a.as_slice()[first..], a.ncols(), count, a.nrows(), 1);
    turned * b.rows(first, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: sums written out, for narrow and wide matrices and parts of them.
    #[test]
    fn products_are_sums_over_rows() {
        for (left, right, rows) in
            [(1, 9, 0..40), (6, 7, 0..40), (8, 3, 5..40), (9, 12, 11..30), (7, 7, 3..6), (6, 6, 40..40)]
        {
            let a = DMatrix::from_fn(40, left, |t, j| ((t * (j + 1)) as f64 * 0.37).sin());
            let b = DMatrix::from_fn(40, right, |t, j| ((t + 3 * j) as f64 * 0.21).cos());
            let product = product(&a, &b, rows.clone());
            assert_eq!(product.shape(), (left, right));
            for i in 0..left {
                for j in 0..right {
                    let sum: f64 = rows.clone().map(|t| a[(t, i)] * b[(t, j)]).sum();
                    assert!((product[(i, j)] - sum).abs() < 1e-12, "{i}, {j} of {rows:?}");
                }
            }
        }
    }
}
