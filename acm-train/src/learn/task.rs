//! A fit: its task, the observer's control, and its result.

use acm_models::burn::tensor::Device;
use acm_models::{Keep, Network, NetworkConfig};

use super::{epoch::Epoch, projection::Projection};
use crate::config::TrainingConfig;

/// A fit: network, settings, device.
#[derive(Debug, Clone)]
pub struct Task<'a> {
    /// The network and its sizes.
    pub network: &'a NetworkConfig,
    /// Epochs, batches, optimizer.
    pub training: &'a TrainingConfig,
    /// Which steps of a training window are supervised. Validation is at the last step, which is what is scored.
    pub supervise: Keep,
    /// Decides the first weights and the order of windows.
    pub seed: u64,
    /// Where to compute, without autodiff.
    pub device: &'a Device,
}

/// Answer of the observer of an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop here; the checkpoint is written already.
    Stop,
}

/// Why training ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All epochs are done.
    Epochs,
    /// The validation loss has not fallen for `patience` epochs.
    Patience,
    /// The observer asked; a checkpoint continues it.
    Asked,
}

/// A fitted network.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// Network with the weights of the best epoch, without autodiff.
    pub network: Network,
    /// Every epoch.
    pub epochs: Vec<Epoch>,
    /// The epoch with the lowest validation loss, from 1; 0 where none is better than the nominal model.
    pub best_epoch: usize,
    /// Epoch 0, where there is one.
    pub zero: Option<Epoch>,
    /// See [`Progress::projections`](super::progress::Progress::projections).
    pub projections: Vec<Projection>,
    /// Shrinkage factor of the network's correction, 0 to 1.
    pub factor: f64,
    /// Why training ended.
    pub ended: Ended,
}
