//! A fitted baseline, and the choice of its best row.

use nalgebra::DMatrix;

use crate::learn::fit::epoch::Epoch;
use crate::learn::fit::task::Ended;

/// A fitted baseline.
#[derive(Debug)]
pub struct Fitted<M> {
    /// Model of the best epoch.
    pub model: M,
    /// Rows of the record, one per penalty or round.
    pub epochs: Vec<Epoch>,
    /// The row with the smallest validation loss, from 1; the first of equals.
    pub best_epoch: usize,
    /// Reason why the fit ended.
    pub ended: Ended,
}

impl<M> Fitted<M> {
    /// Converts the model to another type.
    pub fn map<N>(self, into: impl FnOnce(M) -> N) -> Fitted<N> {
        let Self { model, epochs, best_epoch, ended } = self;
        Fitted { model: into(model), epochs, best_epoch, ended }
    }
}

/// Returns the mean over windows and outputs, as for networks.
pub(super) fn mean_square(predicted: &DMatrix<f64>, target: &DMatrix<f64>) -> f64 {
    let squares: f64 = predicted.iter().zip(target).map(|(p, t)| (p - t) * (p - t)).sum();
    squares / target.len() as f64
}

/// Returns the number of the row with the smallest validation loss, from 1; the first of equals.
pub(super) fn best(epochs: &[Epoch]) -> usize {
    epochs.iter().min_by(|a, b| a.validation_loss.total_cmp(&b.validation_loss)).map_or(1, |best| best.epoch)
}
