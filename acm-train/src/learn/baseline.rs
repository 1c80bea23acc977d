//! Outside baselines: estimators without a network on the same windows.
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

mod fitted;
pub mod forest;
mod lagged;
mod ridge;
mod trees;

use nalgebra::DMatrix;

pub use fitted::Fitted;
pub use lagged::Lagged;

use super::error::LearnError;
use super::fit::epoch::Epoch;
use super::fit::task::Control;
use crate::config::Baseline;

/// Model of the standardised residual.
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
) -> Result<Fitted<Model>, LearnError> {
    for (part, windows) in [("training", training), ("validation", validation)] {
        if windows.is_empty() {
            return Err(LearnError::NoWindows { part });
        }
    }
    match asked {
        Baseline::Ridge(config) => Ok(ridge::fit(config, training, validation, observer)?.map(Model::Ridge)),
        Baseline::BoostedTrees(config) => {
            Ok(trees::fit(config, training, validation, observer)?.map(Model::BoostedTrees))
        }
    }
}

impl Model {
    /// Returns the number of fitted values: coefficients with their constants, or leaves.
    pub fn parameters(&self) -> usize {
        match self {
            Self::Ridge(filter) => filter.parameters(),
            Self::BoostedTrees(boosters) => boosters.leaves(),
        }
    }

    /// Returns the standardised residual at the last step of each window: [N×O].
    pub fn predict(&self, windows: &Lagged) -> DMatrix<f64> {
        match self {
            Self::Ridge(filter) => filter.predict(windows),
            Self::BoostedTrees(boosters) => boosters.predict(windows),
        }
    }
}
