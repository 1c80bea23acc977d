//! The samples that are compared, over all trials, in the order of trials and time.

use rayon::prelude::*;

use crate::diagnose::remainder::{Remainder, TrialRemainder};

/// Position of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Sample {
    /// Index of the trial.
    pub trial: usize,
    /// Index within the trial.
    pub t: usize,
    /// Number of its block.
    pub block: usize,
}

/// Returns the samples of one trial that count and have finite residuals, by their index.
pub(crate) fn counted(trial: &TrialRemainder, outputs: usize) -> Vec<usize> {
    let finite = |t: usize| trial.residual[t * outputs..(t + 1) * outputs].iter().all(|r| r.is_finite());
    (0..trial.record.samples()).filter(|&t| trial.counts[t] && finite(t)).collect()
}

/// Returns all samples that count; of many only every k-th of each trial, so that about `most` are left.
pub(crate) fn samples(remainder: &Remainder, most: usize) -> Vec<Sample> {
    let rows: Vec<Vec<usize>> = remainder.trials.iter().map(|trial| counted(trial, remainder.outputs())).collect();
    let count: usize = rows.iter().map(Vec::len).sum();
    let stride = count.div_ceil(most.max(1)).max(1);
    let of = |(trial, rows): (usize, Vec<usize>)| {
        let block = remainder.trials[trial].block;
        rows.into_iter().step_by(stride).map(move |t| Sample { trial, t, block: block[t] })
    };
    rows.into_iter().enumerate().flat_map(of).collect()
}

/// Returns the residuals of `samples`, [N×M] row by row.
pub(crate) fn residuals(remainder: &Remainder, samples: &[Sample]) -> Vec<f64> {
    let outputs = remainder.outputs();
    let row = |s: &Sample| &remainder.trials[s.trial].residual[s.t * outputs..(s.t + 1) * outputs];
    samples.iter().flat_map(row).copied().collect()
}

/// Returns a column of each trial at `samples`: `of` gives the whole trial, so that columns with memory are possible.
/// Values that are not finite become 0.
pub(crate) fn gather(
    remainder: &Remainder,
    samples: &[Sample],
    of: impl Fn(&TrialRemainder) -> Vec<f64> + Send + Sync,
) -> Vec<f64> {
    let columns: Vec<Vec<f64>> = remainder.trials.par_iter().map(of).collect();
    let pick = |s: &Sample| columns[s.trial].get(s.t).copied().filter(|x| x.is_finite()).unwrap_or(0.0);
    samples.iter().map(pick).collect()
}

/// Returns the median time between neighbouring samples of all trials, s; 0 where there are none.
pub(crate) fn median_step<'a>(times: impl IntoIterator<Item = &'a [f64]>) -> f64 {
    let mut steps: Vec<f64> =
        times.into_iter().flat_map(|time| time.windows(2).map(|pair| pair[1] - pair[0])).collect();
    steps.retain(|step| *step > 0.0);
    median(&mut steps)
}

/// Returns the median, which is the mean of the middle two of an even number, and 0 of none. Sorts the values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let (middle, even) = (values.len() / 2, values.len() % 2 == 0);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even);
    lower.map_or(*upper, |lower| 0.5 * (lower + *upper))
}

/// Returns the mean and standard deviation; 0 and 0 without values.
pub(crate) fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt())
}

/// Standardises a column to mean 0 and variance 1; none where nothing varies.
pub(crate) fn standardised(column: &[f64]) -> Option<Vec<f64>> {
    let (mean, sd) = moments(column);
    let largest = column.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    (sd > 1e-9 * largest).then(|| column.iter().map(|x| (x - mean) / sd).collect())
}
