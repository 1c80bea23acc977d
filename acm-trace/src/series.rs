//! One trial, prepared: which samples are looked at, which count, and the block that each belongs to.
//!
//! Effects act on the full record. The model is evaluated, and compared with what was measured, at every k-th sample: as
//! often as the budget allows, and where outputs may be filtered not more seldom than ten times a second.

use acm_core::record::Record;
use nalgebra::DMatrix;

use crate::case::Trial;

/// A trial with N of its T samples chosen.
#[derive(Debug, Clone)]
pub struct Series {
    /// Of the trial.
    pub name: String,
    /// All T samples.
    pub record: Record,
    /// The N samples that are looked at.
    pub rows: Vec<usize>,
    /// The record at these samples.
    pub thin: Record,
    /// measured [N×M], row by row, SI.
    pub measured: Vec<f64>,
    /// What is added to every prediction [N×M]: s − g where the prediction s comes with the data, else zero.
    pub offset: Vec<f64>,
    /// Whether a sample counts [N]: not in the warm-up.
    pub counts: Vec<bool>,
    /// The block of each sample [N].
    pub block: Vec<usize>,
}

/// Longest time at the start of a trial that may hold traces of what was before it, s.
const WARM_UP: f64 = 3.0;

/// Largest share of a trial that the warm-up takes.
const WARM_UP_SHARE: f64 = 0.06;

/// End of the warm-up in a trial's own time.
pub fn warm_up(time: &[f64]) -> f64 {
    match (time.first(), time.last()) {
        (Some(first), Some(last)) => first + WARM_UP.min(WARM_UP_SHARE * (last - first)),
        _ => 0.0,
    }
}

impl Series {
    /// Every `stride`-th sample of a trial; blocks are set to zero.
    pub fn new(trial: &Trial, stride: usize) -> Self {
        let rows: Vec<usize> = (0..trial.record.samples()).step_by(stride.max(1)).collect();
        let begin = warm_up(&trial.record.time);
        let pick = |matrix: &DMatrix<f64>| -> Vec<f64> {
            rows.iter().flat_map(|&t| matrix.row(t).iter().copied().collect::<Vec<f64>>()).collect()
        };
        let measured = pick(&trial.measured);
        Self {
            name: trial.name.clone(),
            thin: trial.record.select(&rows),
            offset: trial.offset.as_ref().map_or_else(|| vec![0.0; measured.len()], pick),
            measured,
            counts: rows.iter().map(|&t| trial.record.time[t] >= begin).collect(),
            block: vec![0; rows.len()],
            record: trial.record.clone(),
            rows,
        }
    }

    /// Number of samples N.
    pub fn samples(&self) -> usize {
        self.rows.len()
    }
}

/// Trials below this number are cut into blocks of time.
const FEW_TRIALS: usize = 6;

/// Blocks that a few trials are cut into, in all.
const BLOCKS: usize = 12;

/// Numbers the blocks that are left out one at a time: trials, or parts of time of few trials. Returns whether they are trials.
pub fn number_blocks(series: &mut [Series]) -> bool {
    if series.len() >= FEW_TRIALS {
        series.iter_mut().enumerate().for_each(|(b, series)| series.block.fill(b));
        return true;
    }
    let total: usize = series.iter().map(Series::samples).sum();
    let mut next = 0;
    for series in series {
        let share = (BLOCKS * series.samples()) as f64 / total.max(1) as f64;
        let parts = (share.round() as usize).max(2);
        let count = series.samples();
        series.block = (0..count).map(|k| next + k * parts / count).collect();
        next += parts;
    }
    false
}
