//! Progress of a fit: the complete state on which the next epoch depends.

use super::epoch::Epoch;
use super::task::Ended;
use crate::config::TrainingConfig;
use crate::learn::projection::Projection;
use acm_models::optimizer::moments::Moments;

/// The state of a fit between two epochs.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Weights after the last epoch.
    pub weights: Vec<f32>,
    /// Weights after the epoch with the lowest validation loss.
    pub best: Vec<f32>,
    /// The optimizer's averages.
    pub moments: Moments,
    /// Finished epochs.
    pub epochs: Vec<Epoch>,
    /// Epoch 0, where there is one.
    pub zero: Option<Epoch>,
    /// Projections of the validation residual on the correction of each epoch; empty where there is no epoch 0, or no
    /// nominal model.
    pub projections: Vec<Projection>,
}

impl Progress {
    /// Returns the progress before the first epoch.
    pub fn new(weights: Vec<f32>) -> Self {
        let (best, moments) = (weights.clone(), Moments::new(weights.len()));
        Self { weights, best, moments, epochs: Vec::new(), zero: None, projections: Vec::new() }
    }

    /// Records an epoch whose weights are in place, and keeps them if they are the best so far.
    pub fn note(&mut self, epoch: Epoch) {
        let better = self.best_epoch().is_none_or(|best| epoch.validation_loss < best.validation_loss);
        if better {
            self.best.clone_from(&self.weights);
        }
        self.epochs.push(epoch);
    }

    /// Records an epoch whose weights are in place, and keeps them whatever came before.
    pub fn note_last(&mut self, epoch: Epoch) {
        self.best.clone_from(&self.weights);
        self.epochs.push(epoch);
    }

    /// Returns the epoch with the lowest validation loss, which may be epoch 0; the first of equals.
    pub fn best_epoch(&self) -> Option<&Epoch> {
        self.zero.iter().chain(&self.epochs).min_by(|a, b| a.validation_loss.total_cmp(&b.validation_loss))
    }

    /// Returns the factor on the correction of the best epoch: 0 at epoch 0, and 1 where none is estimated.
    pub fn factor(&self) -> f64 {
        match (self.best_epoch(), self.zero) {
            (Some(Epoch { epoch: 0, .. }), _) => 0.0,
            (Some(best), Some(_)) => self.projections.get(best.epoch - 1).map_or(1.0, Projection::factor),
            _ => 1.0,
        }
    }

    /// Returns the reason why there is no further epoch; `None` where there is one.
    pub fn ended(&self, config: &TrainingConfig) -> Option<Ended> {
        let waited = self.epochs.len() - self.best_epoch().map_or(0, |best| best.epoch);
        if self.epochs.len() >= config.epochs {
            Some(Ended::Epochs)
        } else if config.patience > 0 && waited >= config.patience {
            Some(Ended::Patience)
        } else {
            None
        }
    }
}
