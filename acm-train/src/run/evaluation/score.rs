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

use crate::run::record::{PartScores, Score};

/// Measurement and all estimates of one trial at its target time stamps, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialPrediction {
    /// Name of the trial.
    pub trial: String,
    /// Target time stamps `[T]`, s.
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

/// Returns the scores of nominal model, polynomial and network (named `kind`), together and per trial.
pub fn part_scores(trials: &[TrialPrediction], kind: &str) -> PartScores {
    let outputs = trials.first().map_or(0, |trial| trial.measured.ncols());
    let mut residuals = ResidualSums::new(outputs);
    trials.iter().for_each(|trial| residuals.add(&(&trial.measured - &trial.nominal)));
    let mut tally = Tally::new(&residuals, kind);
    trials.iter().for_each(|trial| tally.add(trial));
    tally.scores()
}

/// Sums of the residual over the targets of a part, whose mean R² is taken about.
#[derive(Debug, Clone)]
pub struct ResidualSums {
    samples: usize,
    sums: Vec<f64>,
}

impl ResidualSums {
    /// Returns the sums before the first sample.
    pub fn new(outputs: usize) -> Self {
        Self { samples: 0, sums: vec![0.0; outputs] }
    }

    /// Adds residuals, [T×O].
    pub fn add(&mut self, residual: &DMatrix<f64>) {
        self.samples += residual.nrows();
        for (sum, column) in self.sums.iter_mut().zip(residual.column_iter()) {
            *sum = column.iter().fold(*sum, |sum, r| sum + r);
        }
    }

    fn means(&self) -> Vec<f64> {
        self.sums.iter().map(|sum| mean(*sum, self.samples)).collect()
    }
}

/// Scores of a part whose trials come one after the other: of the part as a whole, sums are kept.
#[derive(Debug, Clone)]
pub struct Tally {
    kind: String,
    means: Vec<f64>,
    whole: Errors,
    trials: BTreeMap<String, BTreeMap<String, Score>>,
}

impl Tally {
    /// Scores before the first trial; `residuals` are the sums over all trials that follow.
    pub fn new(residuals: &ResidualSums, kind: &str) -> Self {
        let means = residuals.means();
        Self { kind: kind.into(), whole: Errors::new(means.len()), means, trials: BTreeMap::new() }
    }

    /// Adds a trial.
    pub fn add(&mut self, trial: &TrialPrediction) {
        self.whole.add(trial, &self.means);
        let residual = &trial.measured - &trial.nominal;
        let means: Vec<f64> = residual.column_iter().map(|r| mean(r.sum(), r.nrows())).collect();
        let mut own = Errors::new(means.len());
        own.add(trial, &means);
        self.trials.insert(trial.trial.clone(), own.scores(&self.kind));
    }

    /// Returns whether no trial was added.
    pub fn is_empty(&self) -> bool {
        self.trials.is_empty()
    }

    /// Returns the scores.
    pub fn scores(self) -> PartScores {
        PartScores { estimators: self.whole.scores(&self.kind), trials: self.trials }
    }
}

type Estimate = fn(&TrialPrediction) -> &DMatrix<f64>;

/// Estimates: nominal model, polynomial, network.
const ESTIMATES: [Estimate; 3] = [|t| &t.nominal, |t| &t.polynomial, |t| &t.predicted];

/// Squared errors of the three estimators, and of the residual about its mean, output by output.
#[derive(Debug, Clone)]
struct Errors {
    samples: usize,
    squares: [Vec<Squares>; 3],
    spread: Vec<Squares>,
}

impl Errors {
    fn new(outputs: usize) -> Self {
        let none = vec![Squares::default(); outputs];
        Self { samples: 0, squares: [none.clone(), none.clone(), none.clone()], spread: none }
    }

    fn add(&mut self, trial: &TrialPrediction, means: &[f64]) {
        self.samples += trial.time.len();
        for (estimate, squares) in ESTIMATES.iter().zip(&mut self.squares) {
            for ((squares, p), e) in
                squares.iter_mut().zip(trial.measured.column_iter()).zip(estimate(trial).column_iter())
            {
                p.iter().zip(e.iter()).for_each(|(p, e)| squares.add(p - e));
            }
        }
        let nominal = trial.nominal.column_iter();
        for (((spread, p), n), mean) in self.spread.iter_mut().zip(trial.measured.column_iter()).zip(nominal).zip(means)
        {
            p.iter().zip(n.iter()).for_each(|(p, n)| spread.add((p - n) + -mean));
        }
    }

    fn scores(&self, kind: &str) -> BTreeMap<String, Score> {
        let names = ["nominal", "polynomial", kind];
        names.iter().zip(&self.squares).map(|(name, squares)| (name.to_string(), self.score(squares))).collect()
    }

    fn score(&self, squares: &[Squares]) -> Score {
        let squared: Vec<f64> = squares.iter().map(Squares::sum).collect();
        let spread = self.spread.iter().map(Squares::sum);
        Score {
            samples: self.samples,
            rmse: squared.iter().map(|&e| mean(e, self.samples).sqrt()).collect(),
            rmse_total: mean(squared.iter().sum(), self.samples).sqrt(),
            r2: squared.iter().zip(spread).map(|(e, r)| if r > 0.0 { 1.0 - e / r } else { 0.0 }).collect(),
        }
    }
}

fn mean(total: f64, samples: usize) -> f64 {
    if samples == 0 { 0.0 } else { total / samples as f64 }
}

/// A sum of squares in the order of nalgebra's `norm_squared`: eight sums side by side, whatever is left at the end one
/// by one. So values that come in pieces give the bits that they give as one column.
#[derive(Debug, Clone, Default)]
struct Squares {
    sums: [f64; 8],
    /// Squares that wait for the rest of a group of eight.
    waiting: [f64; 8],
    count: usize,
}

impl Squares {
    fn add(&mut self, value: f64) {
        self.waiting[self.count] = value * value;
        self.count += 1;
        if self.count == 8 {
            self.sums.iter_mut().zip(&self.waiting).for_each(|(sum, square)| *sum += square);
            self.count = 0;
        }
    }

    fn sum(&self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.sums;
        let eights = [a + e, b + f, c + g, d + h];
        eights.iter().chain(&self.waiting[..self.count]).fold(0.0, |sum, part| sum + part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: nalgebra's own sum over one column.
    #[test]
    fn squares_that_come_one_by_one_have_the_bits_of_a_column() {
        for length in [0, 1, 7, 8, 9, 16, 100, 1003] {
            let column = nalgebra::DVector::from_fn(length, |t, _| (0.1 + t as f64).sin());
            let mut squares = Squares::default();
            column.iter().for_each(|value| squares.add(*value));
            assert_eq!(squares.sum().to_bits(), column.norm_squared().to_bits(), "{length} values");
        }
    }

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
