//! Batches of examples, and the loss over them.

use std::borrow::Cow;

use acm_models::{Keep, Sequences};

use crate::config::Loss;
use crate::learn::correction::Widths;
use crate::learn::loss::{masked, mean_square};

/// Some windows, row after row.
#[derive(Debug, Clone)]
pub struct Batch {
    /// Inputs `[B,W,C]`.
    pub inputs: Vec<f32>,
    /// Elapsed times `[B,W]`, s.
    pub elapsed: Vec<f32>,
    /// Targets `[B,O]`, or `[B,W,O]` where every step is supervised.
    pub targets: Vec<f32>,
    /// Mask of the predictions that count, one for each target; empty where all do.
    pub counted: Vec<bool>,
    /// Loss function.
    pub loss: Loss,
    /// Standardised slopes, `[B,O,A]` or `[B,W,O,A]`; empty where the tip alone is corrected.
    pub slopes: Vec<f32>,
    pub(super) widths: Widths,
    pub(super) steps: usize,
    pub(super) supervise: Keep,
}

impl Default for Batch {
    fn default() -> Self {
        Self::new(vec![], vec![], vec![], 1, Keep::Last)
    }
}

impl Batch {
    /// Returns the batch of windows of `steps` samples, standardised.
    pub fn new(inputs: Vec<f32>, elapsed: Vec<f32>, targets: Vec<f32>, steps: usize, supervise: Keep) -> Self {
        let (counted, slopes, widths) = (vec![], vec![], Widths::default());
        Self { inputs, elapsed, targets, counted, loss: Loss::MeanSquare, slopes, widths, steps, supervise }
    }

    /// Returns the loss as a function of the network's output.
    pub fn loss(&self) -> impl Fn(usize, &[f32], &mut [f32]) -> f64 + Sync {
        let (whole, parts) = (mean_square(&self.targets), masked(self.loss, &self.targets, &self.counted));
        let of_predictions = move |first: usize, predictions: &[f32], derivatives: &mut [f32]| match &self.counted[..] {
            [] => whole(first, predictions, derivatives),
            _ => parts(first, predictions, derivatives),
        };
        move |first, said, derivatives| match self.widths.actuators {
            0 => of_predictions(first, said, derivatives),
            _ => {
                let (row, rows) = (first / self.widths.said(), said.len() / self.widths.said());
                let slopes = self.slopes_of(row, rows);
                let predictions = self.widths.combined(said, slopes);
                let mut by_prediction = vec![0.0; predictions.len()];
                let loss = of_predictions(row * self.widths.outputs, &predictions, &mut by_prediction);
                self.widths.derivatives(&by_prediction, slopes, derivatives);
                loss
            }
        }
    }

    /// Returns the predictions of the network's output.
    pub fn predictions<'a>(&self, said: &'a [f32]) -> Cow<'a, [f32]> {
        match self.widths.actuators {
            0 => said.into(),
            _ => self.widths.combined(said, self.slopes_of(0, said.len() / self.widths.said())).into(),
        }
    }

    fn slopes_of(&self, row: usize, rows: usize) -> &[f32] {
        let width = self.widths.outputs * self.widths.actuators;
        &self.slopes[row * width..(row + rows) * width]
    }

    /// Returns the predictions that count, and their targets.
    pub fn scored<'a>(&'a self, predictions: &'a [f32]) -> [Cow<'a, [f32]>; 2] {
        let counted = |values: &'a [f32]| match &self.counted[..] {
            [] => Cow::Borrowed(values),
            mask => values.iter().zip(mask).filter(|(_, counted)| **counted).map(|(value, _)| *value).collect(),
        };
        [counted(predictions), counted(&self.targets)]
    }

    /// Returns the sum of the loss over the predictions that count, and their number.
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

    /// Returns the batch as a network reads it, from a state of zeros.
    pub fn windows(&self) -> Sequences<'_> {
        let (batch, steps, keep) = (self.elapsed.len() / self.steps, self.steps, self.supervise);
        Sequences { inputs: &self.inputs, elapsed: &self.elapsed, state: None, batch, steps, keep }
    }
}
