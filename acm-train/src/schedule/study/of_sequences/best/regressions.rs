//! Regressions that a network has to beat, beside the prediction without one.

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use super::constant::Constant;
use super::judged::Judged;
use super::ridge::Ridge;
use super::trees::Trees;
use crate::config::Loss;
use crate::learn::LearnError;

/// A fitted regression.
#[derive(Debug)]
pub enum Regression {
    /// Linear in the last steps.
    Ridge(Ridge),
    /// Trees on some of the last steps.
    Trees(Trees),
}

/// Fits all that suit the loss: ridge regression for numbers, trees for numbers and labels. `without` is the prediction without a
/// network, `judged` the validation part.
///
/// # Errors
/// Numbers that trees cannot be grown from.
pub fn fit(set: &SequenceSet, without: &Constant, judged: &Judged, loss: Loss) -> Result<Vec<Regression>, LearnError> {
    let error = |said: &DMatrix<f64>| judged.errors(said).mean();
    let numbers = loss == Loss::MeanSquare;
    let ridge = numbers.then(|| Ridge::fit(set, without, error)).flatten();
    let trees = Trees::fit(set, without, loss)?;
    Ok(ridge.map(Regression::Ridge).into_iter().chain([Regression::Trees(trees)]).collect())
}

impl Regression {
    /// Returns its name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Ridge(_) => "ridge regression",
            Self::Trees(_) => "boosted trees",
        }
    }

    /// Returns the number of its fitted values: coefficients or leaves.
    pub fn numbers(&self) -> usize {
        match self {
            Self::Ridge(ridge) => ridge.numbers(),
            Self::Trees(trees) => trees.numbers(),
        }
    }

    /// Returns its predictions for sequences [N×O].
    pub fn predict(&self, sequences: &[Sequence]) -> DMatrix<f64> {
        match self {
            Self::Ridge(ridge) => ridge.predict(sequences),
            Self::Trees(trees) => trees.predict(sequences),
        }
    }
}
