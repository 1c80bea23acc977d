//! Orthogonal reduction of many rows to one small triangle, row block by row block.
//!
//! ```text
//! [ T ]       [ T' ]          for each column k:   x = (T_kk, block_k),   v = x − α e,   α = −sign(T_kk) ‖x‖
//! [ B ]  = Q· [ 0  ],         every later column j:   c_j ← c_j − v (v·c_j) / (v·v/2)
//! ```
//!
//! | symbol | meaning                           | shape |
//! | `T`    | what the rows so far are reduced to | n × n |
//! | `B`    | the next rows                     | m × n |
//!
//! Householder reflections that touch one row of T and all of B, so that zeros below the diagonal are never stored or
//! computed with. Sums run in parts that are added in a fixed order, whatever the width of the processor's registers.
//! Golub & Van Loan (2013), Matrix Computations, 5.2; Demmel et al. (2012), SIAM J. Sci. Comput. 34(1).

use std::ops::Range;

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

/// Parts of a sum: enough for four of the widest registers, so that no addition waits for the one before.
const PARTS: usize = 32;

/// Parts for the rows left over.
const FEW: usize = 8;

/// Rows that are reduced at a time: they and T stay in the nearest cache.
const ROWS: usize = 192;

/// Reduces the rows of `block` into `triangle`; what is in `block` afterwards has no meaning.
pub(crate) fn absorb(triangle: &mut DMatrix<f64>, block: &mut DMatrix<f64>) {
    let rows = block.nrows();
    for start in (0..rows).step_by(ROWS) {
        Arch::new().dispatch(Absorb { triangle, block, rows: start..(start + ROWS).min(rows) });
    }
}

/// Some rows of a block; a struct, so that the loops below are compiled for the processor's registers.
struct Absorb<'a> {
    triangle: &'a mut DMatrix<f64>,
    block: &'a mut DMatrix<f64>,
    rows: Range<usize>,
}

impl WithSimd for Absorb<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { triangle, block, rows } = self;
        let (n, height) = (triangle.ncols(), block.nrows());
        for k in 0..n {
            let (before, after) = block.as_mut_slice().split_at_mut((k + 1) * height);
            let x = &before[k * height..][rows.clone()];
            let tail = dot(simd, x, x);
            // Nothing to reflect; what is smaller still has no finite inverse.
            if tail < f64::MIN_POSITIVE {
                continue;
            }
            let top = triangle[(k, k)];
            let norm = (top * top + tail).sqrt();
            let alpha = if top > 0.0 { -norm } else { norm };
            let head = top - alpha;
            // 2/(v·v) with v·v/2 = norm² − α T_kk, without cancellation.
            let inverse = 1.0 / (norm * (norm + top.abs()));
            triangle[(k, k)] = alpha;
            for (j, column) in after.chunks_exact_mut(height).enumerate() {
                let (row, column) = (&mut triangle[(k, k + 1 + j)], &mut column[rows.clone()]);
                let share = (head * *row + dot(simd, x, column)) * inverse;
                *row -= share * head;
                subtract(column, share, x);
            }
        }
    }
}

#[inline(always)]
fn dot<S: Simd>(simd: S, a: &[f64], b: &[f64]) -> f64 {
    let mut parts = [simd.splat_f64s(0.0); PARTS];
    let (many, few) = (a.len() - a.len() % PARTS, a.len() - a.len() % FEW);
    accumulate::<S, PARTS>(simd, &a[..many], &b[..many], &mut parts);
    accumulate::<S, FEW>(simd, &a[many..few], &b[many..few], &mut parts);
    halve::<S, PARTS>(simd, &mut parts);
    halve::<S, { PARTS / 2 }>(simd, &mut parts);
    let mut sums = [0.0; FEW];
    S::as_mut_simd_f64s(&mut sums).0.copy_from_slice(&parts[..FEW / S::F64_LANES]);
    let [a0, a1, a2, a3, a4, a5, a6, a7] = sums;
    let mut sum = ((a0 + a4) + (a2 + a6)) + ((a1 + a5) + (a3 + a7));
    for (a, b) in a[few..].iter().zip(&b[few..]) {
        sum += a * b;
    }
    sum
}

/// Adds the products of both, row k to part k modulo N.
#[inline(always)]
fn accumulate<S: Simd, const N: usize>(simd: S, a: &[f64], b: &[f64], parts: &mut [S::f64s; PARTS]) {
    let (a, b) = (S::as_simd_f64s(a).0, S::as_simd_f64s(b).0);
    let registers = N / S::F64_LANES;
    for (a, b) in a.chunks_exact(registers).zip(b.chunks_exact(registers)) {
        for k in 0..registers {
            parts[k] = simd.add_f64s(parts[k], simd.mul_f64s(a[k], b[k]));
        }
    }
}

/// Adds the upper half of N parts to the lower one.
#[inline(always)]
fn halve<S: Simd, const N: usize>(simd: S, parts: &mut [S::f64s; PARTS]) {
    let registers = N / 2 / S::F64_LANES;
    for k in 0..registers {
        parts[k] = simd.add_f64s(parts[k], parts[k + registers]);
    }
}

#[inline(always)]
fn subtract(column: &mut [f64], share: f64, x: &[f64]) {
    for (c, x) in column.iter_mut().zip(x) {
        *c -= share * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: AᵀA is what an orthogonal reduction keeps; more, fewer and as many rows as columns, in one go and in two.
    #[test]
    fn a_triangle_keeps_the_normal_equations() {
        for rows in [1, 4, 5, 97, 300] {
            let a = DMatrix::from_fn(rows, 5, |i, j| ((i * 7 + j * 3) as f64 * 0.7).sin() * 10f64.powi(j as i32 - 2));
            let mut triangle = DMatrix::zeros(5, 5);
            absorb(&mut triangle, &mut a.rows(0, rows / 2).into_owned());
            absorb(&mut triangle, &mut a.rows(rows / 2, rows - rows / 2).into_owned());
            let (mine, theirs) = (triangle.transpose() * &triangle, a.transpose() * &a);
            for (mine, (j, theirs)) in mine.iter().zip(theirs.iter().enumerate()) {
                let scale = (length(&a, j % 5) * length(&a, j / 5)).max(1e-300);
                assert!((mine - theirs).abs() <= 1e-13 * scale, "{rows} rows, entry {j}: {mine} {theirs}");
            }
            assert_eq!(triangle, triangle.upper_triangle());
        }
    }

    fn length(a: &DMatrix<f64>, column: usize) -> f64 {
        a.column(column).norm()
    }

    /// Oracle: by hand, (3, 4) reduces to length 5, and rows of zeros to nothing.
    #[test]
    fn two_rows_by_hand() {
        let mut triangle = DMatrix::zeros(1, 1);
        absorb(&mut triangle, &mut DMatrix::from_row_slice(2, 1, &[3.0, 4.0]));
        assert_eq!(triangle[(0, 0)].abs(), 5.0);
        absorb(&mut triangle, &mut DMatrix::zeros(3, 1));
        assert_eq!(triangle[(0, 0)].abs(), 5.0);
    }

    /// Oracle: the same sums one number at a time.
    #[test]
    fn the_width_of_the_registers_changes_no_bit() {
        let rows = || DMatrix::from_fn(75, 4, |i, j| ((i * 5 + j * 11) as f64 * 0.3).cos());
        let (mut wide, mut narrow) = (DMatrix::zeros(4, 4), DMatrix::zeros(4, 4));
        absorb(&mut wide, &mut rows());
        Absorb { triangle: &mut narrow, block: &mut rows(), rows: 0..75 }.with_simd(pulp::Scalar);
        assert_eq!(wide, narrow);
    }
}
