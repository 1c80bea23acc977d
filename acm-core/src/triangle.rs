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
//! computed with. Sums run in eight parts that are added in a fixed order, on every processor.
//! Golub & Van Loan (2013), Matrix Computations, 5.2; Demmel et al. (2012), SIAM J. Sci. Comput. 34(1).

use nalgebra::DMatrix;
use pulp::Arch;

/// Parts of a sum.
const PARTS: usize = 8;

/// Rows that are reduced at a time: they and T stay in the nearest cache.
const ROWS: usize = 96;

/// Reduces the rows of `block` into `triangle`; what is in `block` afterwards has no meaning.
pub(crate) fn absorb(triangle: &mut DMatrix<f64>, block: &mut DMatrix<f64>) {
    let rows = block.nrows();
    for start in (0..rows).step_by(ROWS) {
        Arch::new().dispatch(|| absorb_rows(triangle, block, start, (start + ROWS).min(rows)));
    }
}

#[inline(always)]
fn absorb_rows(triangle: &mut DMatrix<f64>, block: &mut DMatrix<f64>, start: usize, end: usize) {
    let (n, height) = (triangle.ncols(), block.nrows());
    for k in 0..n {
        let (before, after) = block.as_mut_slice().split_at_mut((k + 1) * height);
        let x = &before[k * height..][start..end];
        let tail = dot(x, x);
        if tail == 0.0 {
            continue;
        }
        let top = triangle[(k, k)];
        let norm = (top * top + tail).sqrt();
        let alpha = if top > 0.0 { -norm } else { norm };
        let head = top - alpha;
        // v·v/2 = norm² − α T_kk, without cancellation.
        let half = norm * (norm + top.abs());
        triangle[(k, k)] = alpha;
        for (j, column) in after.chunks_exact_mut(height).enumerate() {
            let (row, column) = (&mut triangle[(k, k + 1 + j)], &mut column[start..end]);
            let share = (head * *row + dot(x, column)) / half;
            *row -= share * head;
            subtract(column, share, x);
        }
    }
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut parts = [0.0; PARTS];
    let (a, b) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (part, (a, b)) in parts.iter_mut().zip(a.iter().zip(b)) {
            *part += a * b;
        }
    }
    let [a, b, c, d, e, f, g, h] = parts;
    ((a + e) + (b + f)) + ((c + g) + (d + h)) + rest
}

#[inline(always)]
fn subtract(column: &mut [f64], share: f64, x: &[f64]) {
    column.iter_mut().zip(x).for_each(|(c, x)| *c -= share * x);
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
}
