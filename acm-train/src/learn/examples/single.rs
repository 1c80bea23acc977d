//! Conversion to the single precision of a network.

use nalgebra::DMatrix;

/// Converts numbers to the single precision of a network.
pub fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// Returns the rows, one after the other.
pub fn by_rows(values: &DMatrix<f64>) -> Vec<f32> {
    values.row_iter().flat_map(|row| row.iter().map(|&value| value as f32).collect::<Vec<_>>()).collect()
}
