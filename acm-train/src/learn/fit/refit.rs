//! A fit without a validation part: to all trials, for a number of epochs that was chosen before.

use std::path::Path;

use super::epoch::Epoch;
use super::task::{Control, Ended, Fitted, Task};
use super::{Desk, pass, resume};
use crate::learn::checkpoint::{self, Identity};
use crate::learn::error::LearnError;
use crate::learn::examples::Examples;
use crate::learn::optimizer::schedule;

/// Fits a network to the training part for `epochs` epochs of the task's schedule. Each is noted with its training loss in the place of
/// the validation loss.
///
/// # Errors
/// As [`fit`](super::fit).
pub fn refit(
    task: &Task,
    training: &dyn Examples,
    epochs: usize,
    checkpoint: &Path,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted, LearnError> {
    if training.is_empty() {
        return Err(LearnError::NoWindows { part: "training" });
    }
    let mut network = task.network(training);
    let identity = Identity::new(task, training, None);
    let mut progress = resume(Some(checkpoint), &identity, &network)?;
    let mut desk = Desk::new(&network, task.training);
    let mut ended = Ended::Epochs;
    while progress.epochs.len() < epochs && ended == Ended::Epochs {
        let (epoch, learning_rate) = (progress.epochs.len() + 1, schedule::rate(task.training, &progress.epochs));
        let train_loss = pass(task, training, &mut desk, &mut progress)?;
        let epoch = Epoch { epoch, learning_rate, train_loss, validation_loss: train_loss };
        progress.note_last(epoch);
        checkpoint::write(checkpoint, &identity, &network, &progress)?;
        if observer(&epoch) == Control::Stop && progress.epochs.len() < epochs {
            ended = Ended::Asked;
        }
    }
    network.set_values(&progress.best);
    let best_epoch = progress.epochs.len();
    Ok(Fitted { network, epochs: progress.epochs, best_epoch, zero: None, projections: vec![], factor: 1.0, ended })
}
