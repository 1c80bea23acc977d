//! A fit: its task, the observer's control, and its result.

use acm_models::burn::tensor::Device;
use acm_models::{Keep, Network, NetworkConfig};

use super::epoch::Epoch;
use crate::config::TrainingConfig;
use crate::learn::examples::Examples;
use crate::learn::projection::Projection;

/// A fit: network, settings, device.
#[derive(Debug, Clone)]
pub struct Task<'a> {
    /// The network and its sizes.
    pub network: &'a NetworkConfig,
    /// Epochs, batches, optimizer.
    pub training: &'a TrainingConfig,
    /// Steps of a training window that are supervised. Validation is at the last step, which is the scored one.
    pub supervise: Keep,
    /// Seed of the initial weights and of the order of windows.
    pub seed: u64,
    /// Device of the computation, without autodiff.
    pub device: &'a Device,
}

impl Task<'_> {
    /// Returns the network before the first step.
    ///
    /// # Panics
    /// If the configuration was not validated.
    pub fn network(&self, training: &dyn Examples) -> Network {
        let (rule, inputs, outputs) = (self.training.first_values, training.channels(), training.said());
        Network::by(rule, self.network, inputs, outputs, self.seed, self.device)
    }
}

/// Answer of the observer of an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Continue.
    Continue,
    /// Stop; the checkpoint is written already.
    Stop,
}

/// Reason why training ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All epochs are done.
    Epochs,
    /// The validation loss has not fallen for `patience` epochs.
    Patience,
    /// The observer stopped it; a checkpoint continues it.
    Asked,
}

/// A fitted network.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// Network with the weights of the best epoch, without autodiff.
    pub network: Network,
    /// Record of every epoch.
    pub epochs: Vec<Epoch>,
    /// The epoch with the lowest validation loss, from 1; 0 where none is better than the nominal model.
    pub best_epoch: usize,
    /// Epoch 0, where there is one.
    pub zero: Option<Epoch>,
    /// Projections of each epoch; see [`Progress::projections`](super::progress::Progress::projections).
    pub projections: Vec<Projection>,
    /// Shrinkage factor of the network's correction, 0 to 1.
    pub factor: f64,
    /// Reason why training ended.
    pub ended: Ended,
}
