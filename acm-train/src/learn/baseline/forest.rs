//! Gradient-boosted trees over a table of features, one booster per output (library forust).
//!
//! ```text
//! numbers   ŷ = ȳ + Σ_{r ≤ R} η T_r(φ)                      squared loss
//! labels    ln( p / (1 − p) ) = ℓ + Σ_{r ≤ R} η T_r(φ)      cross-entropy; ℓ is that of the share of ones
//! ```
//!
//! | symbol | meaning                                                   | shape |
//! | ------ | --------------------------------------------------------- | ----- |
//! | φ      | features                                                  | `[F]` |
//! | T_r    | tree of round r, fitted to what the rounds before leave   |       |
//! | η      | learning rate                                             |       |
//! | R      | rounds that are kept, for each output                     |       |
//!
//! An output grows until its validation loss has not fallen for `patience` rounds, and keeps the rounds up to the
//! smallest. Each booster works on one thread, several of them side by side, so threads change no sum.
//! Friedman (2001), Annals of Statistics 29(5).

use std::fmt;

use forust_ml::{GradientBooster, Matrix, metric::Metric, objective::ObjectiveType};
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::config::{Loss, TreesConfig};
use crate::learn::error::LearnError;
use crate::learn::fit::epoch::Epoch;

/// One booster per output.
pub struct Forest {
    loss: Loss,
    of_output: Vec<GradientBooster>,
}

/// Features and targets of a part.
#[derive(Debug)]
pub struct Table {
    features: DMatrix<f64>,
    targets: DMatrix<f64>,
    weights: Vec<f64>,
}

impl Table {
    /// Returns the table of features [N×F] and targets [N×O]; labels are 0 and 1.
    ///
    /// # Panics
    /// If the numbers of rows differ.
    pub fn new(features: DMatrix<f64>, targets: DMatrix<f64>) -> Self {
        assert_eq!(features.nrows(), targets.nrows(), "a row of targets for each row of features");
        let weights = vec![1.0; targets.nrows()];
        Self { features, targets, weights }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Returns whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    fn part(&self, output: usize) -> (Matrix<'_, f64>, &[f64], &[f64]) {
        let rows = self.len();
        let target = &self.targets.as_slice()[output * rows..(output + 1) * rows];
        (matrix(&self.features), target, &self.weights)
    }
}

fn matrix(features: &DMatrix<f64>) -> Matrix<'_, f64> {
    Matrix::new(features.as_slice(), features.nrows(), features.ncols())
}

impl Forest {
    /// Grows the trees of each output on `seen`, as long as `unseen` agrees.
    ///
    /// # Errors
    /// Numbers that trees cannot be grown from.
    pub fn grow(config: &TreesConfig, loss: Loss, seen: &Table, unseen: &Table) -> Result<Self, LearnError> {
        let outputs = (0..seen.targets.ncols()).into_par_iter();
        let of_output = outputs.map(|output| grow(config, loss, seen, unseen, output)).collect::<Result<_, _>>()?;
        Ok(Self { loss, of_output })
    }

    /// Returns the number of leaves of the rounds that are kept.
    pub fn leaves(&self) -> usize {
        let trees = self.of_output.iter().flat_map(|booster| &booster.trees[..kept(booster)]);
        trees.flat_map(|tree| &tree.nodes).filter(|node| node.is_leaf).count()
    }

    /// Returns the predictions [N×O] for features [N×F].
    pub fn predict(&self, features: &DMatrix<f64>) -> DMatrix<f64> {
        let boosters = self.of_output.par_iter();
        let estimates: Vec<f64> = boosters.flat_map(|booster| booster.predict(&matrix(features), false)).collect();
        DMatrix::from_vec(features.nrows(), self.of_output.len(), estimates)
    }

    /// Returns the losses after each round, as means over the outputs.
    pub fn epochs(&self) -> Vec<Epoch> {
        let rounds = self.of_output.iter().map(|booster| booster.trees.len()).max().unwrap_or(0);
        (0..rounds).map(|round| self.epoch(round)).collect()
    }

    fn epoch(&self, round: usize) -> Epoch {
        let loss = |part: usize| {
            let of = |booster: &GradientBooster| {
                let round = round.min(kept(booster).max(1) - 1);
                let metric = booster.evaluation_history.as_ref().map_or(f64::NAN, |history| *history.get(round, part));
                if self.loss == Loss::MeanSquare { metric.powi(2) } else { metric }
            };
            self.of_output.iter().map(of).sum::<f64>() / self.of_output.len() as f64
        };
        let learning_rate = self.of_output.first().map_or(0.0, |booster| f64::from(booster.learning_rate));
        Epoch { epoch: round + 1, learning_rate, train_loss: loss(0), validation_loss: loss(1) }
    }
}

impl fmt::Debug for Forest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Forest").field("outputs", &self.of_output.len()).finish_non_exhaustive()
    }
}

/// Returns the number of rounds R that are kept.
fn kept(booster: &GradientBooster) -> usize {
    booster.prediction_iteration.unwrap_or(booster.trees.len())
}

fn grow(
    config: &TreesConfig,
    loss: Loss,
    seen: &Table,
    unseen: &Table,
    output: usize,
) -> Result<GradientBooster, LearnError> {
    let (objective, metric) = match loss {
        // The library's own metric for squared loss is the error of logarithms.
        Loss::MeanSquare => (ObjectiveType::SquaredLoss, Metric::RootMeanSquaredError),
        Loss::CrossEntropy => (ObjectiveType::LogLoss, Metric::LogLoss),
    };
    let mut booster = GradientBooster::default()
        .set_objective_type(objective)
        .set_evaluation_metric(Some(metric))
        .set_initialize_base_score(true)
        .set_iterations(config.rounds)
        .set_early_stopping_rounds(Some(config.patience))
        .set_learning_rate(config.learning_rate as f32)
        .set_max_depth(config.depth)
        .set_min_leaf_weight(config.leaf_windows as f32)
        .set_l2(config.penalty as f32)
        .set_parallel(false);
    let (matrix, target, weights) = seen.part(output);
    let refuse = |error| {
        LearnError::Baseline(format!("trees cannot be grown for output {output}: {error}; check inputs and outputs"))
    };
    let watched = vec![seen.part(output), unseen.part(output)];
    booster.fit(&matrix, target, weights, Some(watched)).map_err(refuse)?;
    Ok(booster)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: where nothing can be told apart, each row has the logit of the share of ones, ln 3 for three of four, and the cross-entropy
    /// is that of the share.
    #[test]
    fn labels_begin_at_their_share() {
        let table = || {
            let label = |row: usize, _| if row % 4 == 0 { 0.0 } else { 1.0 };
            Table::new(DMatrix::from_element(400, 1, 1.0), DMatrix::from_fn(400, 1, label))
        };
        let forest = Forest::grow(&TreesConfig::default(), Loss::CrossEntropy, &table(), &table()).unwrap();
        let said = forest.predict(&DMatrix::from_element(3, 1, 1.0));
        assert!(said.iter().all(|logit| (logit - 3.0_f64.ln()).abs() < 1e-6), "{said}");
        let entropy = -(0.75 * 0.75_f64.ln() + 0.25 * 0.25_f64.ln());
        assert!((forest.epochs()[0].validation_loss - entropy).abs() < 1e-6, "{:?}", forest.epochs());
    }
}
