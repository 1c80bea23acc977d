//! Outside baselines: what an estimator that is no network makes of the same windows.
//!
//! ```toml
//! [baseline]
//! kind = "ridge"           # or "boosted_trees"
//! ```
//!
//! | kind            | estimate                                      | chosen on the validation part | parameters   |
//! | --------------- | --------------------------------------------- | ----------------------------- | ------------ |
//! | `ridge`         | linear in the last samples ([`ridge`])        | penalty                       | coefficients |
//! | `boosted_trees` | a sum of small trees of a few lags ([`trees`]) | number of rounds              | leaves       |
//!
//! A baseline takes the network's place and nothing else: plans, windows, target time stamps and scalers are the same,
//! and so is the record. What a network calls an epoch is a penalty here, from the largest down, or a round. Only the
//! last step of a window is supervised, whatever `windows.target` says, and nothing depends on a seed.

mod config;
mod lagged;
mod ridge;
mod trees;

use nalgebra::DMatrix;

pub use config::{Baseline, RidgeConfig, TreesConfig};
pub use lagged::Lagged;

use crate::{
    learn::{Control, Ended, LearnError},
    record::Epoch,
};

/// A fitted baseline.
#[derive(Debug)]
pub struct Fitted {
    /// As it was at the best epoch.
    pub model: Model,
    /// One row per penalty, or per round.
    pub epochs: Vec<Epoch>,
    /// The row with the smallest validation loss, from 1; the first of equals.
    pub best_epoch: usize,
    /// Whether somebody asked it to stop.
    pub ended: Ended,
}

/// What predicts the standardised residual.
#[derive(Debug)]
pub enum Model {
    /// Linear in the last samples.
    Ridge(ridge::Filter),
    /// A sum of trees for each output.
    BoostedTrees(trees::Boosters),
}

/// Fits a baseline to the training windows, and chooses on the validation windows. `observer` sees each row.
///
/// # Errors
/// A part without windows, or numbers that the fit cannot be computed from.
pub fn fit(
    asked: &Baseline,
    training: &Lagged,
    validation: &Lagged,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted, LearnError> {
    for (part, windows) in [("training", training), ("validation", validation)] {
        if windows.is_empty() {
            return Err(LearnError::NoWindows { part });
        }
    }
    match asked {
        Baseline::Ridge(config) => ridge::fit(config, training, validation, observer),
        Baseline::BoostedTrees(config) => trees::fit(config, training, validation, observer),
    }
}

impl Model {
    /// Numbers that were fitted: coefficients with their constants, or leaves.
    pub fn parameters(&self) -> usize {
        match self {
            Self::Ridge(filter) => filter.parameters(),
            Self::BoostedTrees(boosters) => boosters.leaves(),
        }
    }

    /// Standardised residual at the last step of each window: [N×O].
    pub fn predict(&self, windows: &Lagged) -> DMatrix<f64> {
        match self {
            Self::Ridge(filter) => filter.predict(windows),
            Self::BoostedTrees(boosters) => boosters.predict(windows),
        }
    }
}

/// Mean over windows and outputs, as for networks.
fn mean_square(predicted: &DMatrix<f64>, target: &DMatrix<f64>) -> f64 {
    let squares: f64 = predicted.iter().zip(target).map(|(p, t)| (p - t) * (p - t)).sum();
    squares / target.len() as f64
}

/// Number of the row with the smallest validation loss, from 1; the first of equals.
fn best(epochs: &[Epoch]) -> usize {
    epochs.iter().min_by(|a, b| a.validation_loss.total_cmp(&b.validation_loss)).map_or(1, |best| best.epoch)
}
