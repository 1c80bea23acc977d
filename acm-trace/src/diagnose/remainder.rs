//! Residuals of a model, trial by trial, with the signals that may explain them.

use acm_core::record::Record;
use acm_core::rig::Rig;

/// Residuals of a set of trials.
#[derive(Debug, Clone)]
pub struct Remainder<'a> {
    /// Description of the rig.
    pub rig: &'a Rig,
    /// One entry for each trial.
    pub trials: Vec<TrialRemainder<'a>>,
    /// Root mean square of the white noise, over all outputs together (‖·‖ of a sample).
    pub floor: f64,
}

/// Residuals of one trial: T samples, M outputs, A actuators.
#[derive(Debug, Clone)]
pub struct TrialRemainder<'a> {
    /// Name of the trial.
    pub name: &'a str,
    /// Signals at the T samples.
    pub record: &'a Record,
    /// Residual measured − predicted, [T×M] row by row, in units that make all outputs count alike (m for an arm).
    pub residual: Vec<f64>,
    /// Whether a sample counts `[T]`: not in the warm-up, and measured.
    pub counts: &'a [bool],
    /// Slopes ∂y/∂q [T×M×A], row by row.
    pub slopes: &'a [f64],
    /// Block of each sample `[T]`; blocks are numbered over all trials, and left out one at a time.
    pub block: &'a [usize],
}

impl Remainder<'_> {
    /// Returns the number of outputs M.
    pub fn outputs(&self) -> usize {
        self.rig.outputs.len()
    }

    /// Returns the number of blocks over all trials.
    pub fn blocks(&self) -> usize {
        self.trials.iter().flat_map(|trial| trial.block).max().map_or(0, |last| last + 1)
    }

    /// Returns the mean square of the samples that count, summed over outputs.
    pub fn mean_square(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0usize);
        for trial in &self.trials {
            let rows = trial.residual.chunks_exact(self.outputs()).zip(trial.counts);
            for (row, _) in rows.filter(|(_, counts)| **counts) {
                sum += row.iter().map(|r| r * r).sum::<f64>();
                count += 1;
            }
        }
        if count > 0 { sum / count as f64 } else { 0.0 }
    }
}
