//! Errors by fold, and paired differences between models.
//!
//! ```text
//! d_f = e_f(a) − e_f(b)        a is as good as b:  mean(d) ≤ sd(d)/√K
//! ```
//!
//! | symbol | meaning                              |
//! | ------ | ------------------------------------ |
//! | e_f    | error on fold f, SI                  |
//! | K      | number of folds                      |
//!
//! The differences are of pairs that share trials: how much harder one fold is than another falls out of them.

use serde::{Deserialize, Serialize};

use crate::run::evaluation::spread::Spread;

/// Error of each fold, in the order of the folds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FoldErrors(pub Vec<f64>);

impl FoldErrors {
    /// Returns the mean error over folds; infinite where there is none.
    pub fn mean(&self) -> f64 {
        Spread::of(&self.0).map_or(f64::INFINITY, |spread| spread.mean)
    }

    /// Returns the excess error over another model: mean over folds, and standard error where there are two folds or
    /// more.
    pub fn more_than(&self, other: &Self) -> (f64, Option<f64>) {
        let differences: Vec<f64> = self.0.iter().zip(&other.0).map(|(own, other)| own - other).collect();
        let spread = Spread::of(&differences);
        let se = spread.and_then(|spread| Some(spread.sd? / (differences.len() as f64).sqrt()));
        (spread.map_or(f64::INFINITY, |spread| spread.mean), se)
    }

    /// Returns whether it is within one standard error of another.
    pub fn as_good_as(&self, other: &Self) -> bool {
        let (mean, se) = self.more_than(other);
        mean <= se.unwrap_or(0.0)
    }
}
