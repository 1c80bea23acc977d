//! One run of the protocol: training trials and seed.

use super::record::{FoldStamp, Split, Stage};

/// One network to be trained.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// `fold0-seed1` or `final-seed1`.
    pub id: String,
    /// Which part of the protocol.
    pub stage: Stage,
    /// Seed of the initial weights and of the order of batches.
    pub seed: u64,
    /// How the folds were made, and which of them chooses the epoch.
    pub folds: FoldStamp,
    /// Who learns, who chooses, who waits.
    pub split: Split,
}
