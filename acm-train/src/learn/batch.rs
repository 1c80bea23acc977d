//! Examples that a network reads at a time, and what is minimised over them.

use acm_models::{Keep, Sequences};

use super::loss::{masked, mean_square};
use crate::config::Loss;

/// Some windows, row after row.
#[derive(Debug, Clone)]
pub struct Batch {
    /// `[B,W,C]`.
    pub inputs: Vec<f32>,
    /// `[B,W]`, s.
    pub elapsed: Vec<f32>,
    /// `[B,O]`, or `[B,W,O]` where every step is supervised.
    pub targets: Vec<f32>,
    /// Which predictions count, one for each target; empty where all do.
    pub counted: Vec<bool>,
    /// What is minimised.
    pub loss: Loss,
    pub(super) steps: usize,
    pub(super) supervise: Keep,
}

impl Default for Batch {
    fn default() -> Self {
        Self::new(vec![], vec![], vec![], 1, Keep::Last)
    }
}

impl Batch {
    /// Of windows of `steps` samples, standardised.
    pub fn new(inputs: Vec<f32>, elapsed: Vec<f32>, targets: Vec<f32>, steps: usize, supervise: Keep) -> Self {
        Self { inputs, elapsed, targets, counted: vec![], loss: Loss::MeanSquare, steps, supervise }
    }

    /// The loss as a function of predictions.
    pub fn loss(&self) -> impl Fn(usize, &[f32], &mut [f32]) -> f64 + Sync {
        let (whole, parts) = (mean_square(&self.targets), masked(self.loss, &self.targets, &self.counted));
        let every = self.counted.is_empty();
        move |first, predictions, derivatives| match every {
            true => whole(first, predictions, derivatives),
            false => parts(first, predictions, derivatives),
        }
    }

    /// Sum of the loss over the predictions that count, and their number.
    pub fn error(&self, predictions: &[f32]) -> (f64, usize) {
        let error = |(p, t): (&f32, &f32)| self.loss.of(*p, *t);
        let pairs = predictions.iter().zip(&self.targets);
        if self.counted.is_empty() {
            return (pairs.map(error).sum(), self.targets.len());
        }
        let counted = || self.counted.iter().filter(|counted| **counted);
        (
            pairs.zip(&self.counted).filter(|(_, counted)| **counted).map(|(pair, _)| error(pair)).sum(),
            counted().count(),
        )
    }

    /// As a network reads them, from a state of zeros.
    pub fn windows(&self) -> Sequences<'_> {
        let (batch, steps, keep) = (self.elapsed.len() / self.steps, self.steps, self.supervise);
        Sequences { inputs: &self.inputs, elapsed: &self.elapsed, state: None, batch, steps, keep }
    }
}
