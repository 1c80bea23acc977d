//! One run of the protocol: training trials and seed.

use super::record::{FoldStamp, Split, Stage};

/// One network to be trained.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// Name of the run: `fold0-seed1` or `final-seed1`.
    pub id: String,
    /// Stage of the protocol.
    pub stage: Stage,
    /// Seed of the initial weights and of the order of batches.
    pub seed: u64,
    /// Kind of the folds, and the fold that chooses the epoch.
    pub folds: FoldStamp,
    /// Trials of training, validation and test.
    pub split: Split,
}
