//! One run of the protocol: training trials and seed.

use std::collections::BTreeMap;

use statrs::statistics::{Data, Median};

use crate::learn::Projection;

use super::record::{FoldStamp, RunRecord, Split, Stage};

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

impl Plan {
    /// Returns whether the run learns from all trials: the runs of cross-validation then choose its epoch and factor, and come first.
    pub fn follows_folds(&self) -> bool {
        self.split.has_no_validation()
    }
}

/// Choice of the folds for a run that learns from all trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chosen {
    /// Number of epochs.
    pub epochs: usize,
    /// Factor on the network's correction.
    pub factor: f64,
}

impl Chosen {
    /// Returns the number of epochs of the folds, and the median over the folds of the factor that makes the error of the last epoch
    /// smallest on the trials left out, between 0 and 1. The learning rate falls to zero by the last epoch: an earlier one would stop in
    /// the middle of its way. A median, since a fold outside the range of the others says how the network extrapolates. Without
    /// projections the factor is 1.
    pub fn of(records: &[RunRecord]) -> Self {
        let mut folds: BTreeMap<usize, Projection> = BTreeMap::new();
        for record in records {
            if let (Stage::CrossValidation { fold }, Some(last)) = (record.stage, record.projections.last()) {
                *folds.entry(fold).or_default() += *last;
            }
        }
        let ratios: Vec<f64> = folds.values().map(Projection::ratio).collect();
        let factor = if ratios.is_empty() { 1.0 } else { Data::new(ratios).median().clamp(0.0, 1.0) };
        let folds = records.iter().filter(|record| record.stage != Stage::Final);
        Self { epochs: folds.map(|record| record.epochs.len()).max().unwrap_or(1), factor }
    }
}
