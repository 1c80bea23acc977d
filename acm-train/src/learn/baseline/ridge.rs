//! Ridge regression on lagged inputs: a linear filter of finite memory.
//!
//! ```text
//! φ_k = (x_{k−n+1}, …, x_k)        ŷ_k = ȳ + Wᵀ (φ_k − φ̄)
//! W = argmin Σ_k ‖y_k − ŷ_k‖² / N + λ ‖W‖²  =  (G + λ 1)⁻¹ c,   G = Σ (φ − φ̄)(φ − φ̄)ᵀ / N,   c = Σ (φ − φ̄)(y − ȳ)ᵀ / N
//! ```
//!
//! | symbol | meaning                                     | shape   | unit |
//! | ------ | ------------------------------------------- | ------- | ---- |
//! | n      | lags                                        |         | 1    |
//! | φ, φ̄   | features, their mean over training windows  | [n·C]   | –    |
//! | y, ȳ   | targets, their mean over training windows   | [O]     | –    |
//! | λ      | penalty; the constant ȳ is not penalised    |         | –    |
//! | N      | training windows                            |         | 1    |
//!
//! One triangular factor a penalty; the penalty with the smallest validation loss is kept, the larger of equals.
//! Features are gathered in blocks of windows, so memory is that of G. Hoerl & Kennard (1970), Technometrics 12(1).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::{
    fitted::{Fitted, best, mean_square},
    lagged::Lagged,
};
use crate::config::RidgeConfig;
use crate::learn::error::LearnError;
use crate::learn::fit::epoch::Epoch;
use crate::learn::fit::task::{Control, Ended};

/// Number of windows gathered at a time: 1 MB of features for 125 lagged inputs.
const BLOCK: usize = 1024;

/// Linear filter ŷ = constant + Wᵀ φ.
#[derive(Debug, Clone)]
pub struct Filter {
    lags: usize,
    /// Weights W [n·C×O].
    weights: DMatrix<f64>,
    /// Constants ȳ − Wᵀ φ̄ [O].
    constant: DVector<f64>,
}

/// Tries every penalty, from the largest down.
pub fn fit(
    config: &RidgeConfig,
    training: &Lagged,
    validation: &Lagged,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted<Filter>, LearnError> {
    let moments = Moments::of(training, config.lags.unwrap_or(training.length()));
    let (seen, unseen) = (training.targets(), validation.targets());
    let mut penalties = config.penalties.clone();
    penalties.sort_by(|a, b| b.total_cmp(a));
    let (mut kept, mut epochs, mut ended) = (None, vec![], Ended::Epochs);
    for (index, &penalty) in penalties.iter().enumerate() {
        let filter = moments.solve(penalty)?;
        let epoch = Epoch {
            epoch: index + 1,
            learning_rate: penalty,
            train_loss: mean_square(&filter.predict(training), &seen),
            validation_loss: mean_square(&filter.predict(validation), &unseen),
        };
        epochs.push(epoch);
        if best(&epochs) == epoch.epoch {
            kept = Some(filter);
        }
        if observer(&epoch) == Control::Stop && epoch.epoch < penalties.len() {
            ended = Ended::Asked;
            break;
        }
    }
    let filter = kept.ok_or_else(|| LearnError::Baseline("baseline.penalties is empty; name at least one".into()))?;
    Ok(Fitted { model: filter, best_epoch: best(&epochs), epochs, ended })
}

impl Filter {
    /// Returns the number of coefficients and constants.
    pub fn parameters(&self) -> usize {
        self.weights.len() + self.constant.len()
    }

    /// Returns the predictions [N×O].
    pub fn predict(&self, windows: &Lagged) -> DMatrix<f64> {
        let mut predicted = DMatrix::zeros(windows.len(), windows.outputs());
        for rows in blocks(windows) {
            let mut estimate = features(windows, rows.clone(), self.lags).tr_mul(&self.weights);
            for (mut column, constant) in estimate.column_iter_mut().zip(&self.constant) {
                column.add_scalar_mut(*constant);
            }
            predicted.rows_mut(rows.start, rows.len()).copy_from(&estimate);
        }
        predicted
    }
}

/// Moments of the training windows that a fit needs.
struct Moments {
    lags: usize,
    mean_features: DVector<f64>,
    mean_targets: DVector<f64>,
    /// Matrix G.
    gram: DMatrix<f64>,
    /// Matrix c [n·C×O].
    cross: DMatrix<f64>,
}

impl Moments {
    /// Computes the moments in two passes, means first, since uncentred squares cancel.
    fn of(windows: &Lagged, lags: usize) -> Self {
        let (size, share) = (lags * windows.channels(), 1.0 / windows.len() as f64);
        let mut targets = windows.targets();
        let mean_targets = targets.row_mean().transpose();
        for (mut column, mean) in targets.column_iter_mut().zip(&mean_targets) {
            column.add_scalar_mut(-mean);
        }
        let mut mean_features = DVector::zeros(size);
        for rows in blocks(windows) {
            mean_features += features(windows, rows, lags).column_sum() * share;
        }
        let (mut gram, mut cross) = (DMatrix::zeros(size, size), DMatrix::zeros(size, windows.outputs()));
        for rows in blocks(windows) {
            let mut centred = features(windows, rows.clone(), lags);
            centred.column_iter_mut().for_each(|mut column| column -= &mean_features);
            gram.gemm(share, &centred, &centred.transpose(), 1.0);
            cross.gemm(share, &centred, &targets.rows(rows.start, rows.len()), 1.0);
        }
        Self { lags, mean_features, mean_targets, gram, cross }
    }

    fn solve(&self, penalty: f64) -> Result<Filter, LearnError> {
        let mut normal = self.gram.clone();
        (0..normal.nrows()).for_each(|k| normal[(k, k)] += penalty);
        let factor = normal.cholesky().ok_or_else(|| LearnError::Baseline(singular(penalty)))?;
        let weights = factor.solve(&self.cross);
        let constant = &self.mean_targets - weights.tr_mul(&self.mean_features);
        Ok(Filter { lags: self.lags, weights, constant })
    }
}

fn singular(penalty: f64) -> String {
    format!(
        "baseline.penalties names {penalty:e}, with which the normal equations are singular: some lagged inputs are \
         combinations of others; leave out penalties as small as this"
    )
}

fn blocks(windows: &Lagged) -> impl Iterator<Item = Range<usize>> {
    let count = windows.len();
    (0..count).step_by(BLOCK).map(move |start| start..(start + BLOCK).min(count))
}

/// Returns the features, one window a column: [n·C×B].
fn features(windows: &Lagged, rows: Range<usize>, lags: usize) -> DMatrix<f64> {
    let mut features = DMatrix::zeros(lags * windows.channels(), rows.len());
    for (mut column, window) in features.column_iter_mut().zip(rows) {
        windows.past(window, lags, column.as_mut_slice());
    }
    features
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::baseline::lagged::tests::{identity, one_series, windows};

    fn ridge(inputs: DMatrix<f64>, targets: DMatrix<f64>, lags: usize, penalties: &[f64]) -> (Filter, Vec<Epoch>) {
        let (channels, outputs) = (inputs.ncols(), targets.ncols());
        let series = [one_series(inputs, targets)];
        let (windows, scalers) = (windows(&series, lags), identity(channels, outputs));
        let lagged = Lagged::new(&series, &windows, lags, &scalers);
        let asked = RidgeConfig { lags: None, penalties: penalties.to_vec() };
        let fitted = fit(&asked, &lagged, &lagged, &mut |_| Control::Continue).unwrap();
        (fitted.model, fitted.epochs)
    }

    /// Oracle: by hand. x = 0, 1, 2, 3 and y = 1, 2, 5, 4: S_xx/N = 5/4, S_xy/N = 6/4, so W = 1.5/(1.25 + λ), and the
    /// line passes through the means (1.5, 3) for every λ.
    #[test]
    fn one_input_without_memory() {
        let column = |values: [f64; 4]| DMatrix::from_column_slice(4, 1, &values);
        for (penalty, slope) in [(0.0, 1.2), (0.25, 1.0), (1.75, 0.5)] {
            let (filter, epochs) = ridge(column([0.0, 1.0, 2.0, 3.0]), column([1.0, 2.0, 5.0, 4.0]), 1, &[penalty]);
            assert!((filter.weights[0] - slope).abs() < 1e-14, "{penalty}: {}", filter.weights[0]);
            assert!((filter.constant[0] - (3.0 - 1.5 * slope)).abs() < 1e-14);
            let squares = [(0.0, 1.0), (1.0, 2.0), (2.0, 5.0), (3.0, 4.0)].map(|(x, y)| slope * (x - 1.5) + 3.0 - y);
            let loss = squares.iter().map(|e| e * e).sum::<f64>() / 4.0;
            assert!((epochs[0].train_loss - loss).abs() < 1e-14);
        }
    }

    /// Oracle: by hand, with two inputs. G = ((1, ½), (½, 1)) and c = (1, 0), so Cramer's rule with λ = ½ gives
    /// W = (1.5, −0.5)/2.
    #[test]
    fn two_inputs_that_go_together() {
        let half = 0.75f64.sqrt();
        // Columns a and b of mean 0 and mean square 1 with mean product ½; y = a·4/3 − b·2/3 has ⟨ay⟩ = 1, ⟨by⟩ = 0.
        let (a, e) = ([1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0]);
        let b = [0, 1, 2, 3].map(|k: usize| 0.5 * a[k] + half * e[k]);
        let inputs = DMatrix::from_fn(4, 2, |k, c| if c == 0 { a[k] } else { b[k] });
        let targets = DMatrix::from_fn(4, 1, |k, _| a[k] * 4.0 / 3.0 - b[k] * 2.0 / 3.0);
        let (filter, _) = ridge(inputs, targets, 1, &[0.5]);
        assert!((filter.weights[0] - 0.75).abs() < 1e-14 && (filter.weights[1] + 0.25).abs() < 1e-14, "{filter:?}");
    }

    /// Returns the values between −1 and 1 without a pattern, from the fractional parts of a growing sine.
    fn noise(seed: f64, k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898 + seed).sin() * 43758.547).rem_euclid(1.0) - 1.0
    }

    /// Oracle: a planted filter of three lags, two inputs and two outputs, over more windows than two blocks hold.
    #[test]
    fn a_planted_filter_is_recovered() {
        let samples = 2 * BLOCK + 300;
        let inputs = DMatrix::from_fn(samples, 2, |k, c| 3.0 + noise(c as f64, k));
        let taps = [[0.5, -0.25, 1.0, 0.0, -2.0, 0.125], [0.0, 1.5, 0.0, -0.75, 0.25, 1.0]];
        let planted = |k: usize, o: usize| {
            let past = |j: usize| if k < 2 { 0.0 } else { inputs[(k - 2 + j / 2, j % 2)] };
            0.75 - o as f64 + (0..6).map(|j| taps[o][j] * past(j)).sum::<f64>()
        };
        let targets = DMatrix::from_fn(samples, 2, planted);
        let (filter, epochs) = ridge(inputs, targets, 3, &[1e-14, 1.0]);
        for o in 0..2 {
            assert!((filter.constant[o] - (0.75 - o as f64)).abs() < 1e-10, "{}", filter.constant);
            assert!((0..6).all(|j| (filter.weights[(j, o)] - taps[o][j]).abs() < 1e-10), "{}", filter.weights);
        }
        assert_eq!(filter.parameters(), 14);
        assert!(epochs[1].validation_loss < 1e-20 && epochs[0].learning_rate == 1.0, "{epochs:?}");
    }

    #[test]
    fn an_endless_penalty_leaves_the_mean() {
        let inputs = DMatrix::from_fn(40, 1, |k, _| noise(0.0, k));
        let targets = DMatrix::from_fn(40, 1, |k, _| (k % 4) as f64);
        let (filter, _) = ridge(inputs, targets, 1, &[1e12]);
        assert!((filter.constant[0] - 1.5).abs() < 1e-10 && filter.weights[0].abs() < 1e-10, "{filter:?}");
    }

    /// Noise is learned by heart with a small penalty, which other noise finds out.
    #[test]
    fn the_penalty_is_chosen_on_windows_that_were_not_fitted() {
        let part = |seed: f64| {
            let inputs = DMatrix::from_fn(60, 1, |k, _| noise(seed, k));
            let targets = DMatrix::from_fn(60, 1, |k, _| 0.3 * inputs[k] + noise(seed + 0.7, k));
            [one_series(inputs, targets)]
        };
        let (seen, unseen, scalers) = (part(0.0), part(5.0), identity(1, 1));
        let (a, b) = (windows(&seen, 20), windows(&unseen, 20));
        let [seen, unseen] = [(&seen, &a), (&unseen, &b)].map(|(s, w)| Lagged::new(s, w, 20, &scalers));
        let config = RidgeConfig { lags: None, penalties: vec![1e-6, 1.0, 1e6] };
        let fitted = fit(&config, &seen, &unseen, &mut |_| Control::Continue).unwrap();
        assert_eq!((fitted.best_epoch, fitted.epochs[1].learning_rate), (2, 1.0), "{:?}", fitted.epochs);
        assert!(fitted.epochs[2].train_loss < fitted.epochs[1].train_loss);
    }

    #[test]
    fn equal_inputs_without_a_penalty_are_refused() {
        let series = [one_series(DMatrix::from_element(30, 1, 0.0), DMatrix::from_fn(30, 1, |k, _| k as f64))];
        let (windows, scalers) = (windows(&series, 2), identity(1, 1));
        let lagged = Lagged::new(&series, &windows, 2, &scalers);
        let config = RidgeConfig { lags: None, penalties: vec![0.0] };
        let error = fit(&config, &lagged, &lagged, &mut |_| Control::Continue).unwrap_err().to_string();
        assert!(error.contains("baseline.penalties names 0e0") && error.contains("singular"), "{error}");
    }

    #[test]
    fn it_stops_when_asked() {
        let series = [one_series(DMatrix::from_fn(9, 1, |k, _| noise(0.0, k)), DMatrix::from_element(9, 1, 1.0))];
        let (windows, scalers) = (windows(&series, 1), identity(1, 1));
        let lagged = Lagged::new(&series, &windows, 1, &scalers);
        let stopped = fit(&RidgeConfig::default(), &lagged, &lagged, &mut |_| Control::Stop).unwrap();
        assert_eq!((stopped.epochs.len(), stopped.ended), (1, Ended::Asked));
    }
}
