//! Least squares by Levenberg and Marquardt, with slopes by differences and lower bounds.
//!
//! ```text
//! (JᵀJ + λ diag JᵀJ) δ = −Jᵀ r,   x ← max(x + δ, bound),   J by forward differences of 10⁻⁴ of each value's scale
//! ```
//!
//! Marquardt (1963), J. SIAM 11(2).

use nalgebra::{DMatrix, DVector};

/// A free variable of a fit.
pub struct Variable {
    /// Size of a change that shows.
    pub scale: f64,
    /// Smallest value.
    pub lower: f64,
    /// Whether it keeps its value.
    pub held: bool,
}

/// Steps at most.
const STEPS: usize = 25;
/// A relative gain below this is none.
const GAIN: f64 = 1e-8;

/// Returns the values of least squared residuals that are found from `start` on. It never ends above where it starts.
pub fn fit(residuals: &dyn Fn(&[f64]) -> Vec<f64>, start: &[f64], variables: &[Variable]) -> Vec<f64> {
    let free: Vec<usize> = (0..start.len()).filter(|k| !variables[*k].held).collect();
    let (mut values, mut left) = (start.to_vec(), DVector::from_vec(residuals(start)));
    let mut damping = 1e-4;
    for _ in 0..STEPS {
        let slopes = slopes(residuals, &values, &left, variables, &free);
        let (normal, right) = (slopes.tr_mul(&slopes), slopes.tr_mul(&left));
        let before = left.norm_squared();
        let Some((better, rest)) =
            improve(residuals, &values, before, variables, &free, (&normal, &right), &mut damping)
        else {
            break;
        };
        (values, left) = (better, rest);
        if before - left.norm_squared() <= GAIN * before {
            break;
        }
    }
    values
}

/// Returns the standard errors of the free values for white residuals of standard deviation `noise`; infinite for
/// values that the data leave undetermined, zero for fixed ones.
///
/// ```text
/// Cov = σ² (JᵀJ)⁻¹
/// ```
pub fn standard_errors(
    residuals: &dyn Fn(&[f64]) -> Vec<f64>,
    values: &[f64],
    variables: &[Variable],
    noise: f64,
) -> Vec<f64> {
    let free: Vec<usize> = (0..values.len()).filter(|k| !variables[*k].held).collect();
    let left = DVector::from_vec(residuals(values));
    let slopes = slopes(residuals, values, &left, variables, &free);
    let inverse = slopes.tr_mul(&slopes).try_inverse();
    let mut errors = vec![0.0; values.len()];
    for (k, &at) in free.iter().enumerate() {
        let variance = inverse.as_ref().map_or(f64::INFINITY, |inverse| inverse[(k, k)]);
        errors[at] = if variance > 0.0 { noise * variance.sqrt() * variables[at].scale } else { f64::INFINITY };
    }
    errors
}

/// Returns the first damped step that lowers the sum of squares.
fn improve(
    residuals: &dyn Fn(&[f64]) -> Vec<f64>,
    values: &[f64],
    before: f64,
    variables: &[Variable],
    free: &[usize],
    (normal, right): (&DMatrix<f64>, &DVector<f64>),
    damping: &mut f64,
) -> Option<(Vec<f64>, DVector<f64>)> {
    for _ in 0..8 {
        let mut damped = normal.clone();
        (0..free.len()).for_each(|k| damped[(k, k)] += *damping * normal[(k, k)] + 1e-12 * normal.trace());
        let step = damped.cholesky()?.solve(right);
        let mut moved = values.to_vec();
        for (k, &at) in free.iter().enumerate() {
            moved[at] = (moved[at] - step[k] * variables[at].scale).max(variables[at].lower);
        }
        let rest = DVector::from_vec(residuals(&moved));
        if rest.norm_squared() < before {
            *damping = (0.2 * *damping).max(1e-9);
            return Some((moved, rest));
        }
        *damping *= 8.0;
    }
    None
}

/// Computes ∂r/∂x of the free values, each in units of its scale.
fn slopes(
    residuals: &dyn Fn(&[f64]) -> Vec<f64>,
    values: &[f64],
    left: &DVector<f64>,
    variables: &[Variable],
    free: &[usize],
) -> DMatrix<f64> {
    let mut slopes = DMatrix::zeros(left.len(), free.len());
    for (column, &at) in free.iter().enumerate() {
        let mut moved = values.to_vec();
        moved[at] += 1e-4 * variables[at].scale;
        let change = DVector::from_vec(residuals(&moved)) - left;
        slopes.set_column(column, &(change / 1e-4));
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the planted values of a decay, from a start that is a third off; a bound that is met; a value that is held.
    #[test]
    fn planted_values_are_found() {
        let data: Vec<f64> = (0..50).map(|k| 2.0 * (-0.1 * f64::from(k) / 0.7).exp()).collect();
        let model = |x: &[f64]| -> Vec<f64> {
            data.iter().enumerate().map(|(k, y)| x[0] * (-0.1 * k as f64 / x[1]).exp() + x[2] - y).collect()
        };
        let variable = |lower, held| Variable { scale: 1.0, lower, held };
        let free = [variable(0.0, false), variable(0.1, false), variable(-1.0, false)];
        let found = fit(&model, &[1.3, 1.0, 0.1], &free);
        assert!((found[0] - 2.0).abs() < 1e-5 && (found[1] - 0.7).abs() < 1e-5, "{found:?}");
        // A constant's standard error is that of a mean.
        let mean = standard_errors(
            &|x| vec![x[0] - 1.0; 25],
            &[1.0],
            &[Variable { scale: 3.0, lower: 0.0, held: false }],
            2.0,
        );
        assert!((mean[0] - 2.0 / 5.0).abs() < 1e-9, "{mean:?}");
        let bounded = [variable(3.0, false), variable(0.1, false), variable(0.0, true)];
        let found = fit(&model, &[3.5, 1.0, 0.0], &bounded);
        assert!((found[0] - 3.0).abs() < 1e-9 && found[2] == 0.0, "{found:?}");
    }
}
