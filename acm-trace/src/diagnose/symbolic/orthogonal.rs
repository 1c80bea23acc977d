//! Vectors beside orthonormal directions. Gram–Schmidt, twice: Giraud, Langou & Rozložník (2005), Comput. Math.
//! Appl. 50(7).

use nalgebra::{DVectorView, DVectorViewMut};

/// Share of a term's mean square beside the others below which it counts as rounding.
pub(super) const RANK: f64 = 1e-6;

/// Returns the unit vector of `vector` without its components along orthonormal `others`; none where the remainder is
/// rounding.
pub(super) fn direction(vector: Vec<f64>, others: &[Vec<f64>]) -> Option<Vec<f64>> {
    let whole = norm(&vector);
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
