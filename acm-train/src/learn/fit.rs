//! The training loop.
//!
//! An epoch meets every training window once (or whatever the examples are), then the validation windows are predicted. Training ends after the last
//! epoch, when the validation loss has not fallen for `patience` epochs, or when the observer asks. The weights of the
//! epoch with the lowest validation loss are restored, and proven: predicted again, they must give that loss to the bit.
//! Epoch 0 is the nominal model, and takes part ([`start`]).

pub(super) mod epoch;
pub mod evaluate;
pub(super) mod not_finite;
pub mod progress;
mod refit;
mod start;
pub(super) mod task;

use std::path::Path;

use acm_models::{Engine, Keep, Network};

use super::checkpoint::{self, Identity};
use super::dropout::Dropout;
use super::error::LearnError;
use super::examples::batch::Batch;
use super::examples::{Examples, order};
use super::optimizer::{self, schedule};
use crate::config::TrainingConfig;
use acm_models::optimizer::clip::clip;
use epoch::Epoch;
use not_finite::NotFinite;
use progress::Progress;
pub use refit::refit;
use task::{Control, Ended, Fitted, Task};

/// Fits a network to the training windows, choosing the epoch on the validation windows.
///
/// With a `checkpoint`, a fit that the file holds is continued, and the file is replaced after each epoch: a fit that
/// was interrupted between any two epochs ends in the same bits as one that was not. `observer` sees each epoch after
/// its checkpoint.
///
/// # Errors
/// See [`LearnError`]; the checkpoint of the last whole epoch is kept.
///
/// # Panics
/// If the task was not validated.
pub fn fit(
    task: &Task,
    training: &dyn Examples,
    validation: &dyn Examples,
    checkpoint: Option<&Path>,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted, LearnError> {
    refuse_empty(training, validation)?;
    let network = task.network(training);
    let identity = Identity::new(task, training, Some(validation));
    let mut progress = resume(checkpoint, &identity, &network)?;
    refuse_to_train_imported(task, &progress)?;
    let mut desk = Desk::new(&network, task.training);
    if task.training.has_epoch_zero() && progress.zero.is_none() {
        start::note(&network, training, validation, &mut desk.engine, &mut progress);
    }
    let ended = loop {
        if let Some(ended) = progress.ended(task.training) {
            break ended;
        }
        let epoch = epoch(task, training, validation, &mut desk, &mut progress)?;
        progress.note(epoch);
        if let Some(path) = checkpoint {
            checkpoint::write(path, &identity, &network, &progress)?;
        }
        if observer(&epoch) == Control::Stop {
            break progress.ended(task.training).unwrap_or(Ended::Asked);
        }
    };
    restore(network, validation, &mut desk, progress, ended)
}

/// Buffers that are reused by every step.
struct Desk {
    engine: Engine,
    batch: Batch,
    gradient: Vec<f32>,
    dropout: Option<Dropout>,
}

impl Desk {
    fn new(network: &Network, training: &TrainingConfig) -> Self {
        Self {
            engine: Engine::new(network),
            batch: Batch::default(),
            gradient: vec![0.0; network.parameter_count()],
            dropout: Dropout::new(training.dropout.unwrap_or(0.0), network),
        }
    }
}

fn refuse_empty(training: &dyn Examples, validation: &dyn Examples) -> Result<(), LearnError> {
    match (training.is_empty(), validation.is_empty()) {
        (true, _) => Err(LearnError::NoWindows { part: "training" }),
        (_, true) => Err(LearnError::NoWindows { part: "validation" }),
        _ => Ok(()),
    }
}

fn refuse_to_train_imported(task: &Task, progress: &Progress) -> Result<(), LearnError> {
    match &task.training.imported {
        Some(imported) if progress.epochs.is_empty() => Err(LearnError::NotTrainedHere { file: imported.file.clone() }),
        _ => Ok(()),
    }
}

fn resume(checkpoint: Option<&Path>, identity: &Identity, network: &Network) -> Result<Progress, LearnError> {
    let found = checkpoint.map(|path| checkpoint::read(path, identity, network)).transpose()?.flatten();
    Ok(found.unwrap_or_else(|| Progress::new(network.values())))
}

/// Makes one pass over the training windows and evaluates the validation windows.
fn epoch(
    task: &Task,
    training: &dyn Examples,
    validation: &dyn Examples,
    desk: &mut Desk,
    progress: &mut Progress,
) -> Result<Epoch, LearnError> {
    let (number, learning_rate) = (progress.epochs.len() + 1, schedule::rate(task.training, &progress.epochs));
    let train_loss = pass(task, training, desk, progress)?;
    let (validation_loss, projection) = evaluate::validate(&mut desk.engine, &progress.weights, validation);
    if !validation_loss.is_finite() {
        let all: Vec<usize> = (0..validation.len()).collect();
        let found = NotFinite::of(&mut desk.engine, &progress.weights, validation, &all, Keep::Last);
        let found = NotFinite { epoch: number, what: "validation loss", batch: None, learning_rate, ..found };
        return Err(LearnError::NotFinite(Box::new(found)));
    }
    progress.projections.extend(projection.filter(|_| progress.zero.is_some()));
    Ok(Epoch { epoch: number, learning_rate, train_loss, validation_loss })
}

/// Makes one pass over the training windows, and returns their mean loss as they were met.
fn pass(task: &Task, training: &dyn Examples, desk: &mut Desk, progress: &mut Progress) -> Result<f64, LearnError> {
    let Desk { engine, batch, gradient, dropout } = desk;
    let number = progress.epochs.len() + 1;
    if let Some(dropout) = dropout {
        dropout.begin(task.seed, number);
    }
    let learning_rate = schedule::rate(task.training, &progress.epochs);
    let refuse = |what, batch, found| {
        LearnError::NotFinite(Box::new(NotFinite { epoch: number, what, batch, learning_rate, ..found }))
    };
    let mut sum = 0.0;
    let order = order::draw(training.len(), task.training.drawn(training.len()), task.seed, number);
    let order = training.arrange(order, task.training.batch);
    let batches = order.len().div_ceil(task.training.batch);
    for (done, chosen) in order.chunks(task.training.batch).enumerate() {
        training.gather(chosen, task.supervise, batch);
        let weights = dropout.as_mut().map_or(&*progress.weights, |dropout| dropout.masked(&progress.weights));
        let value = engine.gradient(weights, &batch.windows(), &batch.loss(), gradient);
        if let Some(dropout) = dropout {
            dropout.unmask(gradient);
        }
        let what = if value.is_finite() { "gradient" } else { "training loss" };
        if !value.is_finite() || descend(task.training, learning_rate, gradient, progress).is_none() {
            let found = NotFinite::of(engine, &progress.weights, training, chosen, task.supervise);
            return Err(refuse(what, Some((done + 1, batches)), found));
        }
        sum += value * chosen.len() as f64;
    }
    Ok(sum / order.len() as f64)
}

/// Takes one step of the optimizer; `None` if the gradient is not finite.
fn descend(config: &TrainingConfig, rate: f64, gradient: &mut [f32], progress: &mut Progress) -> Option<()> {
    let norm = clip(gradient, config.clip_norm.unwrap_or(f64::INFINITY));
    if !norm.is_finite() {
        return None;
    }
    let decay = config.weight_decay.unwrap_or(config.optimizer.default_weight_decay());
    optimizer::step(config.optimizer, decay, rate, &mut progress.moments, &mut progress.weights, gradient);
    Some(())
}

/// Restores the best weights, and checks their validation loss.
fn restore(
    mut network: Network,
    validation: &dyn Examples,
    desk: &mut Desk,
    progress: Progress,
    ended: Ended,
) -> Result<Fitted, LearnError> {
    let best = *progress.best_epoch().expect("validated: at least one epoch");
    network.set_values(&progress.best);
    let found = evaluate::loss(&mut desk.engine, &network.values(), validation);
    if found.to_bits() != best.validation_loss.to_bits() {
        return Err(LearnError::BestNotReproduced { epoch: best.epoch, noted: best.validation_loss, found });
    }
    let factor = progress.factor();
    let Progress { epochs, zero, projections, .. } = progress;
    Ok(Fitted { network, epochs, best_epoch: best.epoch, zero, projections, factor, ended })
}
