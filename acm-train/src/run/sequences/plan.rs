//! Networks of a question: one for each row and seed.

use crate::config::{Elapsed, Question, TrainingConfig};

/// One network to be trained.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Name of the run: `measured-seed1`, `one-seed1`.
    pub id: String,
    /// Elapsed times that the network receives.
    pub elapsed: Elapsed,
    /// Seed of the initial weights and of the order of batches.
    pub seed: u64,
    /// Training settings with the row's own number of epochs.
    pub training: TrainingConfig,
}

/// Returns the plans, row after row, seed after seed.
pub fn plans(question: &Question) -> Vec<Plan> {
    let control = question.control.iter().map(|control| (control.elapsed, control.epochs));
    let rows = std::iter::once((question.elapsed, None)).chain(control);
    rows.flat_map(|(elapsed, epochs)| {
        let training =
            TrainingConfig { epochs: epochs.unwrap_or(question.training.epochs), ..question.training.clone() };
        question.seeds.iter().map(move |&seed| {
            let id = format!("{}-seed{seed}", elapsed.name());
            Plan { id, elapsed, seed, training: training.clone() }
        })
    })
    .collect()
}
