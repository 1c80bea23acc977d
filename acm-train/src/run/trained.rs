//! A finished run, read back: what its networks need beside a robot.

use std::path::Path;

use acm_datasets::Series;

use super::{error::RunError, plan::Plan, setting::Setting, train::Run};
use crate::config::device;
use crate::learn::checkpoint::{self, Identity};
use crate::learn::{Scalers, Task, ensemble};

/// Networks of a run, with what their inputs and answers are measured against.
#[derive(Debug, Clone)]
pub struct Trained {
    /// Scalers of the training part.
    pub scalers: Scalers,
    /// Smallest and largest value of each channel in the training part.
    pub ranges: Vec<(f64, f64)>,
    /// Weights of each member.
    pub weights: Vec<Vec<f32>>,
}

impl Trained {
    /// Reads the `members` networks of a plan from the checkpoints in a run folder. A checkpoint has a hash of the examples that
    /// the run had, after scaling: data that have changed since are found out.
    ///
    /// # Errors
    /// A checkpoint is missing, or is of another run or other data.
    pub fn read(setting: &Setting, plan: &Plan, members: usize, folder: &Path) -> Result<Self, RunError> {
        let run = Run::new(setting, plan)?;
        // Whatever device trained it, its weights are the same numbers.
        let device = device("flex")?;
        let training = run.training.training_examples(&run.scalers)?;
        let validation = match plan.split.has_no_validation() {
            true => None,
            false => Some(run.validation.scored_examples(&run.scalers)?),
        };
        let weights = |member: usize| {
            let task = Task { seed: ensemble::seed(plan.seed, member), ..run.task(&device) };
            let identity = Identity::new(&task, &*training, validation.as_deref());
            let path = ensemble::checkpoint(&folder.join(format!("checkpoints/{}.safetensors", plan.id)), member);
            let progress = checkpoint::read(&path, &identity, &task.network(&*training))?;
            Ok(progress.ok_or_else(|| missing(&path))?.best)
        };
        let weights = (0..members).map(weights).collect::<Result<_, RunError>>()?;
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); setting.channels.len()];
        run.training.each(&mut |series| widen(&mut ranges, series))?;
        Ok(Self { scalers: run.scalers, ranges, weights })
    }
}

/// Widens the range of each channel by the samples of a series.
fn widen(ranges: &mut [(f64, f64)], series: &Series) {
    for ((low, high), column) in ranges.iter_mut().zip(series.inputs.column_iter()) {
        *low = column.iter().copied().fold(*low, f64::min);
        *high = column.iter().copied().fold(*high, f64::max);
    }
}

fn missing(checkpoint: &Path) -> RunError {
    RunError::Unusable {
        what: format!("{}: the checkpoint is missing", checkpoint.display()),
        help: "bring it back, or delete its record and run `acm-train --resume`".into(),
    }
}
