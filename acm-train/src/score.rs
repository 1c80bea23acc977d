//! Errors of an estimator against the measurement.
//!
//! ```text
//! RMSE_o = √( Σ_t (p_o − p̂_o)² / T )        RMSE = √( Σ_o RMSE_o² )        R²_o = 1 − Σ_t (p_o − p̂_o)² / Σ_t (r_o − r̄_o)²
//! ```
//!
//! | symbol | meaning                             | shape | unit |
//! | ------ | ----------------------------------- | ----- | ---- |
//! | p, p̂   | measured, estimated output          | [T×O] | m    |
//! | r      | residual, p minus nominal           | [T×O] | m    |
//!
//! R² so defined is 0 for an estimator that adds the residual's mean to the nominal model, and 1 for a perfect one.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use crate::record::{PartScores, Score};

/// Measurement and all estimates of one trial at its target time stamps, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialPrediction {
    /// Name of the trial.
    pub trial: String,
    /// Target time stamps [T], s.
    pub time: Vec<f64>,
    /// Measured outputs [T×O].
    pub measured: DMatrix<f64>,
    /// Nominal model [T×O].
    pub nominal: DMatrix<f64>,
    /// Polynomial comparator [T×O].
    pub polynomial: DMatrix<f64>,
    /// Nominal model plus what the network adds [T×O].
    pub predicted: DMatrix<f64>,
}

/// Scores of nominal model, polynomial and network (named `kind`), together and per trial.
pub fn part_scores(trials: &[TrialPrediction], kind: &str) -> PartScores {
    let all: Vec<&TrialPrediction> = trials.iter().collect();
    let each = |t: &TrialPrediction| (t.trial.clone(), estimators(&[t], kind));
    PartScores { estimators: estimators(&all, kind), trials: trials.iter().map(each).collect() }
}

type Estimate = fn(&TrialPrediction) -> &DMatrix<f64>;

fn estimators(trials: &[&TrialPrediction], kind: &str) -> BTreeMap<String, Score> {
    let estimates: [(&str, Estimate); 3] =
        [("nominal", |t| &t.nominal), ("polynomial", |t| &t.polynomial), (kind, |t| &t.predicted)];
    let scored = |(name, estimate): (&str, Estimate)| (name.to_string(), score(trials, estimate));
    estimates.into_iter().map(scored).collect()
}

fn score(trials: &[&TrialPrediction], estimate: Estimate) -> Score {
    let measured = stack(trials, |t| &t.measured);
    let residual = &measured - stack(trials, |t| &t.nominal);
    let error = measured - stack(trials, estimate);
    let samples = error.nrows();
    let mean = |total: f64| if samples == 0 { 0.0 } else { total / samples as f64 };
    let squared: Vec<f64> = error.column_iter().map(|e| e.norm_squared()).collect();
    let spread = residual.column_iter().map(|r| r.add_scalar(-mean(r.sum())).norm_squared());
    Score {
        samples,
        rmse: squared.iter().map(|&e| mean(e).sqrt()).collect(),
        rmse_total: mean(squared.iter().sum()).sqrt(),
        r2: squared.iter().zip(spread).map(|(e, r)| if r > 0.0 { 1.0 - e / r } else { 0.0 }).collect(),
    }
}

/// Rows of all trials, one below the other.
fn stack(trials: &[&TrialPrediction], of: Estimate) -> DMatrix<f64> {
    let rows = trials.iter().map(|t| of(t).nrows()).sum();
    let outputs = trials.first().map_or(0, |t| of(t).ncols());
    let mut all = DMatrix::zeros(rows, outputs);
    let mut start = 0;
    for part in trials.iter().map(|t| of(t)) {
        all.rows_mut(start, part.nrows()).copy_from(part);
        start += part.nrows();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(name: &str, measured: &[f64], predicted: &[f64]) -> TrialPrediction {
        let matrix = |values: &[f64]| DMatrix::from_row_slice(values.len() / 2, 2, values);
        let zero = matrix(&vec![0.0; measured.len()]);
        TrialPrediction {
            trial: name.into(),
            time: vec![0.0; measured.len() / 2],
            measured: matrix(measured),
            nominal: zero.clone(),
            polynomial: zero,
            predicted: matrix(predicted),
        }
    }

    /// Oracle: hand arithmetic. Residual x = 1, 3 (mean 2, spread 2), error x = 0, 1; residual y is constant.
    #[test]
    fn two_samples_by_hand() {
        let scores = part_scores(&[trial("a", &[1.0, 2.0], &[1.0, 2.0]), trial("b", &[3.0, 2.0], &[2.0, 0.0])], "gru");
        let network = &scores.estimators["gru"];
        assert_eq!(network.samples, 2);
        assert_eq!(network.rmse, [0.5f64.sqrt(), 2.0f64.sqrt()]);
        assert_eq!(network.rmse_total, 2.5f64.sqrt());
        assert_eq!(network.r2, [0.5, 0.0]);
        assert_eq!(scores.estimators["nominal"].rmse, [5.0f64.sqrt(), 2.0]);
        assert_eq!(scores.estimators["nominal"].r2, [1.0 - 10.0 / 2.0, 0.0]);
        assert_eq!(scores.trials["b"]["gru"].rmse, [1.0, 2.0]);
    }

    #[test]
    fn no_samples_give_zeros_and_no_nan() {
        let scores = part_scores(&[trial("a", &[], &[])], "gru");
        assert_eq!(scores.estimators["gru"].rmse_total, 0.0);
    }
}
