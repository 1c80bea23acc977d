//! A run with an imported network: its checkpoint is written, and the run continues to its record.
//!
//! To the fit this is a run of one epoch that is done already, with the losses that the network has on this run's windows. So
//! record, predictions, page, stream and export read it as any other.

use acm_models::{Engine, Network};

use super::{error::RunError, plan::Plan, setting::Setting, train::Run};
use crate::config::device;
use crate::learn::checkpoint::{self, Identity};
use crate::learn::fit::evaluate;
use crate::learn::fit::progress::Progress;
use crate::learn::import::{ImportError, Tensor, rescale, row};
use crate::learn::{Epoch, Examples, LearnError, Scalers, Task};
use crate::store::RunFolder;

/// An imported network.
#[derive(Debug, Clone)]
pub struct Foreign {
    /// Name of the file, for people.
    pub file: String,
    /// Parameters of the network.
    pub tensors: Vec<Tensor>,
    /// Scalers of its training; none where it was trained on this run's standardised channels and residual.
    pub scalers: Option<Scalers>,
}

/// Imported network as the checkpoint of a plan, before it is written.
#[derive(Debug)]
pub struct Arrival {
    id: String,
    identity: Identity,
    network: Network,
    progress: Progress,
}

impl Arrival {
    /// Computes the losses of the network on the windows of a plan.
    ///
    /// # Errors
    /// The tensors are not those of the experiment's network.
    pub fn new(setting: &Setting, plan: &Plan, foreign: &Foreign) -> Result<Self, RunError> {
        let run = Run::new(setting, plan)?;
        let device = device(&setting.experiment.device)?;
        let task = run.task(&device);
        let training = run.training.training_examples(&run.scalers)?;
        let validation = run.validation.scored_examples(&run.scalers)?;
        let network = task.network(&*training);
        let weights = weights(foreign, &task, &*training, &run.scalers)
            .map_err(|error| LearnError::Import { file: foreign.file.clone(), error })?;
        let mut engine = Engine::new(&network);
        let mut loss = |examples: &dyn Examples| evaluate::loss(&mut engine, &weights, examples);
        let (train_loss, validation_loss) = (loss(&*training), loss(&*validation));
        let mut progress = Progress::new(weights);
        progress.note(Epoch { epoch: 1, learning_rate: 0.0, train_loss, validation_loss });
        let identity = Identity::new(&task, &*training, Some(&*validation));
        Ok(Self { id: plan.id.clone(), identity, network, progress })
    }

    /// Writes the checkpoint into the folder of its run.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn write(&self, folder: &RunFolder) -> Result<(), RunError> {
        Ok(checkpoint::write(&folder.checkpoint(&self.id), &self.identity, &self.network, &self.progress)?)
    }
}

/// Returns the network's weights for the scalers of this run.
fn weights(
    foreign: &Foreign,
    task: &Task,
    training: &dyn Examples,
    scalers: &Scalers,
) -> Result<Vec<f32>, ImportError> {
    let shape = task.network.shape(training.channels(), training.outputs());
    let mut weights = row(&shape, &foreign.tensors)?;
    if let Some(from) = &foreign.scalers {
        rescale(&shape, &mut weights, from, scalers)?;
    }
    Ok(weights)
}
