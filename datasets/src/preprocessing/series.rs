//! A trial as network input: inputs, elapsed times, targets, and segments between gaps.
//!
//! ```text
//! Δt_k = t_k − t_{k−1},   a gap is Δt_k > Δt_max: it starts a new segment
//! target = residual = measured − nominal
//! ```
//!
//! The first sample of a segment has no predecessor; its elapsed time is the median step of the trial.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::DMatrix;

use crate::preprocessing::channel::Channel;
use crate::preprocessing::segments::{median_step, segments};
use crate::trial::Trial;

/// Inputs and target of one trial: `T` samples, `C` channels, `O` outputs, all SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The trial.
    pub trial: String,
    /// `[T]`, s.
    pub time: Vec<f64>,
    /// `[T]`, s; the first of a segment is the median step.
    pub elapsed: Vec<f64>,
    /// `[T×C]`.
    pub inputs: DMatrix<f64>,
    /// `[T×O]`, measured − nominal; a row of NaN where no output was measured.
    pub target: DMatrix<f64>,
    /// `[T×O]`.
    pub nominal: DMatrix<f64>,
    /// `[T×O]`; a row of NaN where no output was measured.
    pub measured: DMatrix<f64>,
    /// Runs of samples without a gap.
    pub segments: Vec<Range<usize>>,
    /// `[T×(O·A)]`: ∂nominal_o/∂q_a in column o·A + a, where a network corrects the actuators; no columns elsewhere.
    pub slopes: DMatrix<f64>,
}

impl Series {
    /// Returns whether the outputs of a sample were measured.
    pub fn is_measured(&self, sample: usize) -> bool {
        self.measured.row(sample).iter().all(|value| !value.is_nan())
    }

    /// Returns the targets of all samples that were measured, `[N×O]`.
    pub fn targets(&self) -> Cow<'_, DMatrix<f64>> {
        let measured: Vec<usize> = (0..self.time.len()).filter(|sample| self.is_measured(*sample)).collect();
        match measured.len() == self.time.len() {
            true => Cow::Borrowed(&self.target),
            false => Cow::Owned(self.target.select_rows(&measured)),
        }
    }
}

/// The series of a trial with all its samples ([`Trial::with_unmeasured`]).
///
/// `nominal` is `[T×O]` at the reported outputs `tip`; `max_gap` is in s.
///
/// # Panics
/// If samples without an output are apart, or `nominal` has not one row per sample and one column per output of `tip`.
pub fn series(trial: &Trial, nominal: DMatrix<f64>, tip: Range<usize>, channels: &[Channel], max_gap: f64) -> Series {
    assert!(trial.unmeasured.is_none(), "trial {} without some of its inputs", trial.name);
    assert_eq!(nominal.shape(), (trial.samples(), tip.len()), "nominal prediction of trial {}", trial.name);
    let segments = segments(&trial.time, max_gap);
    let elapsed = elapsed(&trial.time, &segments);
    let mut inputs = DMatrix::zeros(trial.samples(), channels.len());
    for (channel, mut column) in channels.iter().zip(inputs.column_iter_mut()) {
        column.copy_from_slice(&channel.values(trial, &segments));
    }
    let measured = trial.measured.columns_range(tip).into_owned();
    let target = &measured - &nominal;
    let (trial, time) = (trial.name.clone(), trial.time.clone());
    let slopes = DMatrix::zeros(time.len(), 0);
    Series { trial, time, elapsed, inputs, target, nominal, measured, segments, slopes }
}

fn elapsed(time: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
    let mut elapsed = vec![median_step(time, segments); time.len()];
    for t in segments.iter().flat_map(|s| s.clone().skip(1)) {
        elapsed[t] = time[t] - time[t - 1];
    }
    elapsed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Steps 1, 1, 4 (a gap), 2, 1; the median of 1, 1, 2, 1 is 1.
    #[test]
    fn the_first_step_of_a_segment_is_the_median() {
        let time = [10.0, 11.0, 12.0, 16.0, 18.0, 19.0];
        assert_eq!(elapsed(&time, &[0..3, 3..6]), [1.0, 1.0, 1.0, 1.0, 2.0, 1.0]);
        assert_eq!(elapsed(&[3.0], &[0..1]), [0.0]);
    }
}
