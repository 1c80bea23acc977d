//! Components orthogonal to given directions. Gram–Schmidt, twice: Giraud, Langou & Rozložník (2005), Comput. Math. Appl. 50(7).

use nalgebra::{DMatrix, DVectorView, DVectorViewMut};

use crate::tall::product;

/// Part orthogonal to others, relative to the whole, below which it is rounding.
pub(super) const RANK: f64 = 1e-6;

/// Vectors of a panel: most of the work is then a matrix product.
const PANEL: usize = 32;

/// Returns an orthonormal basis of the columns of a matrix. One that depends on those before it up to rounding adds none.
pub(super) fn basis(columns: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let (rows, count) = columns.shape();
    let mut found: Vec<Vec<f64>> = Vec::new();
    for first in (0..count).step_by(PANEL) {
        let panel = columns.columns(first, PANEL.min(count - first));
        let others = DMatrix::from_iterator(rows, found.len(), found.iter().flatten().copied());
        let mut left = panel.into_owned();
        for _ in 0..2 {
            left -= &others * product(&others, &left, 0..rows);
        }
        let first = found.len();
        for (left, whole) in left.column_iter().zip(panel.column_iter()) {
            let own = direction_of(left.iter().copied().collect(), &found[first..], whole.norm());
            found.extend(own);
        }
    }
    found
}

/// Returns the unit vector of `vector` without its components along orthonormal `others`; none where the remainder is
/// rounding.
pub(super) fn direction(vector: Vec<f64>, others: &[Vec<f64>]) -> Option<Vec<f64>> {
    let whole = norm(&vector);
    direction_of(vector, others, whole)
}

/// Does the same for a vector whose norm was `whole` before components were removed.
fn direction_of(vector: Vec<f64>, others: &[Vec<f64>], whole: f64) -> Option<Vec<f64>> {
    // Twice, because once leaves rounding of the size of what was taken away.
    let left = without(without(vector, others), others);
    let norm = norm(&left);
    (norm > RANK * whole).then(|| left.into_iter().map(|x| x / norm).collect())
}

/// Returns a vector without its components along orthonormal directions.
pub(super) fn without(mut vector: Vec<f64>, directions: &[Vec<f64>]) -> Vec<f64> {
    let rows = vector.len();
    let mut left = DVectorViewMut::from_slice(&mut vector, rows);
    for direction in directions {
        let direction = DVectorView::from_slice(direction, rows);
        let along = left.dot(&direction);
        left.axpy(-along, &direction, 1.0);
    }
    vector
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definition, and the rank by singular values: 70 columns in three panels, of which every seventh is a sum of two others and
    /// one is zero.
    #[test]
    fn a_basis_is_orthonormal_and_spans_all_columns() {
        let mut columns = DMatrix::from_fn(90, 70, |t, j| ((t * t + 1) as f64 * (0.37 * j as f64 + 0.11)).sin());
        for j in (7..70).step_by(7) {
            let sum = columns.column(j - 1) * 2.0 - columns.column(j - 3);
            columns.set_column(j, &sum);
        }
        columns.column_mut(40).fill(0.0);
        let found = basis(&columns);
        assert_eq!(found.len(), columns.clone().svd(false, false).rank(1e-6));
        let unit = DMatrix::from_fn(90, found.len(), |t, k| found[k][t]);
        assert!((unit.tr_mul(&unit) - DMatrix::identity(found.len(), found.len())).amax() < 1e-12);
        assert!((&unit * unit.tr_mul(&columns) - &columns).amax() < 1e-12);
    }
}
