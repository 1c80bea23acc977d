//! A loss that is not finite: its batch, and the trials of its windows.

use std::fmt;

use acm_models::{Engine, Keep};

use crate::learn::examples::Examples;
use crate::learn::examples::batch::Batch;

/// Trials that are named.
const NAMED: usize = 8;

/// Place where a loss or its gradient ceased to be finite.
#[derive(Debug, Clone, PartialEq)]
pub struct NotFinite {
    /// The run, where there are several.
    pub run: String,
    /// Epoch, from 1.
    pub epoch: usize,
    /// Name of the value: `training loss`, `gradient` or `validation loss`.
    pub what: &'static str,
    /// Number of the batch and of all batches; none for the validation part, which is looked at as a whole.
    pub batch: Option<(usize, usize)>,
    /// Learning rate of that epoch.
    pub learning_rate: f64,
    /// Number of windows that were examined.
    pub windows: usize,
    /// Number of windows whose prediction or loss is not finite.
    pub broken: usize,
    /// Trials of those that are; where there is none, of all of them.
    pub trials: Vec<String>,
}

impl NotFinite {
    /// Examines the examples `chosen` one by one, with the weights as they were before the step.
    pub(super) fn of(
        engine: &mut Engine,
        weights: &[f32],
        examples: &dyn Examples,
        chosen: &[usize],
        keep: Keep,
    ) -> Self {
        let (mut batch, mut predictions) = (Batch::default(), Vec::new());
        let mut finite = |index: usize| {
            examples.gather(&[index], keep, &mut batch);
            engine.predict(weights, &batch.windows(), &mut predictions);
            batch.error(&batch.predictions(&predictions)).0.is_finite()
        };
        let broken: Vec<usize> = chosen.iter().copied().filter(|index| !finite(*index)).collect();
        let named = if broken.is_empty() { chosen } else { &broken };
        let mut trials: Vec<String> = named.iter().map(|index| examples.whose(*index)).collect();
        trials.sort();
        trials.dedup();
        Self {
            run: String::new(),
            epoch: 0,
            what: "training loss",
            batch: None,
            learning_rate: 0.0,
            windows: chosen.len(),
            broken: broken.len(),
            trials,
        }
    }

    fn trials(&self) -> String {
        let shown = self.trials.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
        let more = self.trials.len().saturating_sub(NAMED);
        if more > 0 { format!("{shown} and {more} more") } else { shown }
    }
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { run, epoch, what, batch, learning_rate, windows, broken, .. } = self;
        if !run.is_empty() {
            write!(f, "{run}, ")?;
        }
        write!(f, "epoch {epoch}")?;
        if let Some((number, all)) = batch {
            write!(f, ", batch {number} of {all}")?;
        }
        write!(f, ": the {what} is not finite (learning rate {learning_rate:.3e})")?;
        match broken {
            0 => write!(f, "; the batch has windows of {}", self.trials())?,
            some if some < windows => write!(f, "; it comes from {some} of {windows} windows, of {}", self.trials())?,
            _ => write!(
                f,
                "; so are all {windows} windows there, of {}: the weights have grown without bounds",
                self.trials()
            )?,
        }
        match epoch {
            1 => write!(f, "; no epoch is finished")?,
            2 => write!(f, "; epoch 1 is kept in the checkpoint")?,
            _ => write!(f, "; epochs 1 to {} are kept in the checkpoint", epoch - 1)?,
        }
        if (1..*windows).contains(broken) {
            return write!(f, "; look at the values of these trials (acm-data describe), or exclude them");
        }
        write!(f, "; lower training.learning_rate or weight_decay, or limit the gradient with training.clip_norm = 1.0")
    }
}
