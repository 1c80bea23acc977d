//! Normal equations, so that a block can be left out by subtraction.

use nalgebra::{DMatrix, DVector};

/// Normal equations of a few columns.
#[derive(Clone)]
pub(super) struct Normal {
    /// Products XᵀX.
    pub gram: DMatrix<f64>,
    /// Products Xᵀr.
    pub right: DVector<f64>,
    /// Squared norm ‖r‖².
    pub squares: f64,
}

impl Normal {
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram + &other.gram,
            right: &self.right + &other.right,
            squares: self.squares + other.squares,
        }
    }

    pub fn less(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram - &other.gram,
            right: &self.right - &other.right,
            squares: self.squares - other.squares,
        }
    }

    /// Returns the coefficients; a column that depends linearly on the others gets zero.
    pub fn solve(mut self) -> DVector<f64> {
        let scale: Vec<f64> = (0..self.right.len()).map(|k| self.gram[(k, k)].sqrt().max(f64::MIN_POSITIVE)).collect();
        for i in 0..scale.len() {
            self.right[i] /= scale[i];
            for j in 0..scale.len() {
                self.gram[(i, j)] /= scale[i] * scale[j];
            }
            self.gram[(i, i)] += 1e-9;
        }
        let solution = self.gram.cholesky().map(|factor| factor.solve(&self.right));
        let mut solution = solution.unwrap_or_else(|| DVector::zeros(scale.len()));
        solution.iter_mut().zip(&scale).for_each(|(x, scale)| *x /= scale);
        solution
    }
}
