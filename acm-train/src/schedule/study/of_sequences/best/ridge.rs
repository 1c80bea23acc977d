//! Ridge regression on the inputs of the last steps: what a network has to beat beside the prediction without one.
//!
//! ```text
//! p_k = b_k + ȳ + Wᵀ (φ_k − φ̄)        φ_k = (x_k, Δt_k, …, x_{k−n+1}, Δt_{k−n+1})
//! W   = (G + λ 1)⁻¹ c,   G = Σ (φ − φ̄)(φ − φ̄)ᵀ / N,   c = Σ (φ − φ̄)(t − b − ȳ)ᵀ / N
//! ```
//!
//! | symbol | meaning                                                                                | shape    |
//! | ------ | -------------------------------------------------------------------------------------- | -------- |
//! | x, Δt  | inputs and time since the step before, standardised; 0 before a sequence begins        | [C], 1   |
//! | t, p   | target and prediction                                                                  | [O]      |
//! | b      | the last value of each target where that is the prediction without a network, else 0   | [O]      |
//! | φ̄, ȳ   | means over the N steps of the training part that have targets                          | [n(C+1)], [O] |
//! | n, λ   | lags and penalty, those with the smallest error on the validation part                 | –        |

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::{DMatrix, DVector};

use super::constant::Constant;
use super::features::Inputs;
use crate::run::sequences::scores::targets;

/// Numbers of lags that are tried.
const LAGS: [usize; 4] = [1, 2, 4, 8];

/// Largest number of features.
const MOST: usize = 512;

/// Penalties that are tried, for standardised inputs.
const PENALTIES: [f64; 7] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];

/// A fitted regression.
#[derive(Debug, Clone)]
pub struct Ridge {
    without: Constant,
    inputs: Inputs,
    lags: usize,
    weights: DMatrix<f64>,
    offset: DVector<f64>,
}

/// Sums over the training part.
struct Moments {
    features: DVector<f64>,
    targets: DVector<f64>,
    gram: DMatrix<f64>,
    cross: DMatrix<f64>,
}

impl Ridge {
    /// Returns the regression with the smallest `error` of its predictions for the validation part; none where the normal
    /// equations cannot be solved. `without` is the prediction without a network.
    pub fn fit(set: &SequenceSet, without: &Constant, error: impl Fn(&DMatrix<f64>) -> f64) -> Option<Self> {
        let inputs = Inputs::of(&set.training);
        let width = inputs.width();
        let most = (MOST / width).clamp(1, LAGS[LAGS.len() - 1]);
        let moments = Moments::of(&set.training, without, &inputs, most);
        let mut best: Option<(f64, Self)> = None;
        for lags in LAGS.into_iter().filter(|lags| *lags <= most) {
            for penalty in PENALTIES {
                let Some((weights, offset)) = moments.solve(lags * width, penalty) else { continue };
                let one = Self { without: without.clone(), inputs: inputs.clone(), lags, weights, offset };
                let left = error(&one.predict(&set.validation));
                if best.as_ref().is_none_or(|(least, _)| left < *least) {
                    best = Some((left, one));
                }
            }
        }
        best.map(|(_, one)| one)
    }

    /// Returns the number of its fitted values.
    pub fn numbers(&self) -> usize {
        self.weights.len() + self.offset.len()
    }

    /// Returns its predictions for sequences [N×O].
    pub fn predict(&self, sequences: &[Sequence]) -> DMatrix<f64> {
        let lags: Vec<usize> = (0..self.lags).collect();
        let mut predicted = self.without.last(sequences);
        let mut row = 0;
        for sequence in sequences {
            let mut own = self.inputs.lagged(sequence, &lags) * &self.weights;
            own.row_iter_mut().for_each(|mut row| row += self.offset.transpose());
            let mut rows = predicted.rows_mut(row, own.nrows());
            rows += &own;
            row += own.nrows();
        }
        predicted
    }
}

impl Moments {
    fn of(sequences: &[Sequence], without: &Constant, inputs: &Inputs, lags: usize) -> Self {
        let wanted = targets(sequences) - without.last(sequences);
        let lags: Vec<usize> = (0..lags).collect();
        let (size, outputs, count) = (lags.len() * inputs.width(), wanted.ncols(), wanted.nrows() as f64);
        let mut sums = Self {
            features: DVector::zeros(size),
            targets: wanted.row_sum().transpose() / count,
            gram: DMatrix::zeros(size, size),
            cross: DMatrix::zeros(size, outputs),
        };
        let mut row = 0;
        for sequence in sequences {
            let features = inputs.lagged(sequence, &lags);
            let own = wanted.rows(row, features.nrows());
            sums.features += features.row_sum().transpose() / count;
            let across = features.transpose();
            sums.gram.gemm(1.0 / count, &across, &features, 1.0);
            sums.cross.gemm(1.0 / count, &across, &own, 1.0);
            row += features.nrows();
        }
        sums.gram -= &sums.features * sums.features.transpose();
        sums.cross -= &sums.features * sums.targets.transpose();
        sums
    }

    /// Returns weights and offset with the first `size` features.
    fn solve(&self, size: usize, penalty: f64) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let mut normal = self.gram.view((0, 0), (size, size)).into_owned();
        (0..size).for_each(|k| normal[(k, k)] += penalty);
        let weights = normal.cholesky()?.solve(&self.cross.rows(0, size).into_owned());
        let offset = &self.targets - weights.tr_mul(&self.features.rows(0, size));
        Some((weights, offset))
    }
}

#[cfg(test)]
mod tests {
    use acm_datasets::sequences::Asked;

    use super::*;

    /// A sequence whose next x is x + 0.5 u + 0.25 (the u before) + 2.
    fn sequence(seed: usize) -> Sequence {
        let u: Vec<f64> = (0..9).map(|k| ((seed * 17 + k * 7) as f64).sin()).collect();
        let before = |k: usize| if k == 0 { 0.0 } else { u[k - 1] };
        let mut x = vec![seed as f64];
        (0..9).for_each(|k| x.push(x[k] + 0.5 * u[k] + 0.25 * before(k) + 2.0));
        Sequence {
            name: format!("{seed}"),
            elapsed: vec![1.0; 9],
            inputs: DMatrix::from_fn(9, 2, |k, c| if c == 0 { x[k] } else { u[k] }),
            targets: DMatrix::from_fn(8, 1, |k, _| x[k + 2]),
        }
    }

    /// Oracle: the truth is linear in the inputs of two steps beside the last value, so that little is left, on sequences that it was
    /// not fitted to.
    #[test]
    fn a_linear_step_is_found() {
        let set = SequenceSet {
            channels: vec!["x".into(), "u".into()],
            outputs: vec!["x".into()],
            asked: Asked::Every,
            training: (0..12).map(sequence).collect(),
            validation: (20..24).map(sequence).collect(),
            test: vec![],
        };
        let wanted = targets(&set.validation);
        let error = |said: &DMatrix<f64>| (said - &wanted).norm_squared() / wanted.len() as f64;
        for (without, most) in [(Constant::LastValue(vec![0]), 1e-6), (Constant::Number(vec![0.0]), 1e-3)] {
            let ridge = Ridge::fit(&set, &without, error).unwrap();
            let left = error(&ridge.predict(&set.validation));
            assert!(left < most, "{left} with {} lags", ridge.lags);
            assert!(error(&without.predict(&set.validation)) > 1.0);
        }
    }
}
