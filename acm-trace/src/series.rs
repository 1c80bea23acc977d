//! One prepared trial: samples that are compared, and the block of each.
//!
//! Effects act on the full record. The model is evaluated, and compared with the measurement, at every k-th sample: as often as the budget
//! allows.

pub mod before;
pub mod curved;
pub mod stepwise;

use acm_core::InterSample;
use acm_core::record::Record;
use nalgebra::DMatrix;

use crate::case::Trial;
use before::Before;

/// A trial with N of its T samples chosen.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name of the trial.
    pub name: String,
    /// Record of all samples: those of the lead first, and inter-sample values.
    pub record: Record,
    /// Inter-sample behaviour of actuators.
    pub inter_sample: InterSample,
    /// The N compared samples, as rows of the record.
    pub rows: Vec<usize>,
    /// Whether the record begins with a lead.
    pub is_led: bool,
    /// The record at these samples.
    pub thin: Record,
    /// Measured values [N×M], row by row, SI.
    pub measured: Vec<f64>,
    /// Prediction that came with the data [T×M].
    pub predicted: Option<DMatrix<f64>>,
    /// Fixed part of every prediction [N×M]: s − g where the prediction s comes with the data, else zero.
    pub offset: Vec<f64>,
    /// Whether a sample counts `[N]`: not in the warm-up.
    pub counts: Vec<bool>,
    /// The block of each sample `[N]`.
    pub block: Vec<usize>,
    /// Whether the trial only calibrates.
    pub calibrates: bool,
}

/// Warm-up at the start of a trial, which may depend on its history: smallest time, s, and number of samples.
const WARM_UP: (f64, usize) = (3.0, 20);

/// Largest share of a trial that the warm-up takes.
const WARM_UP_SHARE: f64 = 0.06;

/// Returns the end of the warm-up in a trial's own time.
pub fn warm_up(time: &[f64]) -> f64 {
    match (time.first(), time.last()) {
        (Some(first), Some(last)) => {
            let (length, step) = (last - first, (last - first) / time.len() as f64);
            first + WARM_UP.0.max(WARM_UP.1 as f64 * step).min(WARM_UP_SHARE * length)
        }
        _ => 0.0,
    }
}

impl Series {
    /// Takes every `stride`-th measured sample of a trial; blocks are set to zero.
    pub fn new(trial: &Trial, stride: usize) -> Self {
        let stride = stride.max(1);
        let rows: Vec<usize> = trial.measured_rows().into_iter().step_by(stride).collect();
        let (record, lead) = trial.led(stride);
        let begin = warm_up(&record.time);
        let pick = |matrix: &DMatrix<f64>| -> Vec<f64> {
            rows.iter().flat_map(|&t| matrix.row(t).iter().copied().collect::<Vec<f64>>()).collect()
        };
        let measured = pick(&trial.measured);
        Self {
            name: trial.name.clone(),
            thin: trial.record.select(&rows),
            offset: trial.offset.as_ref().map_or_else(|| vec![0.0; measured.len()], pick),
            measured,
            predicted: trial.predicted.clone(),
            counts: rows.iter().map(|&t| trial.record.time[t] >= begin).collect(),
            block: vec![0; rows.len()],
            calibrates: false,
            rows: rows.iter().map(|&t| lead + t).collect(),
            is_led: lead > 0,
            record: record.into_owned(),
            inter_sample: InterSample::Straight,
        }
    }

    /// Returns the series with inter-sample values; its actuators must be interpolated linearly.
    #[must_use]
    pub fn between(&self, inter_sample: &InterSample) -> Self {
        let (record, rows) = inter_sample.of(&self.record);
        let rows = self.rows.iter().map(|&t| rows[t]).collect();
        Self { record, rows, inter_sample: inter_sample.clone(), ..self.clone() }
    }

    /// Returns the series with a history of its actuators; it must have no lead.
    #[must_use]
    pub fn begun(&self, before: &Before) -> Self {
        let record = before.ahead_of(&self.record);
        Self { record, rows: self.rows.iter().map(|t| t + before.samples()).collect(), is_led: true, ..self.clone() }
    }

    /// Returns a series with every `every`-th sample of the record and every `fewer`-th of those that are compared.
    #[must_use]
    pub fn decimated(&self, every: usize, fewer: usize) -> Self {
        let looked_at: Vec<usize> = (0..self.rows.len()).step_by(fewer).collect();
        // In a whole record, the compared samples are a subset of all samples.
        let every_one = (0..self.record.samples()).step_by(every);
        let mut left: Vec<usize> = every_one.chain(looked_at.iter().map(|&n| self.rows[n])).collect();
        left.sort_unstable();
        left.dedup();
        let width = self.measured.len() / self.rows.len().max(1);
        let numbers = |all: &[f64]| looked_at.iter().flat_map(|&n| all[n * width..][..width].to_vec()).collect();
        Self {
            name: self.name.clone(),
            record: self.record.select(&left),
            inter_sample: self.inter_sample.clone(),
            rows: looked_at.iter().map(|&n| left.partition_point(|&t| t < self.rows[n])).collect(),
            is_led: self.is_led,
            thin: self.thin.select(&looked_at),
            measured: numbers(&self.measured),
            predicted: self.predicted.as_ref().map(|given| given.select_rows(&left)),
            offset: numbers(&self.offset),
            counts: looked_at.iter().map(|&n| self.counts[n]).collect(),
            block: looked_at.iter().map(|&n| self.block[n]).collect(),
            calibrates: self.calibrates,
        }
    }

    /// Returns the number of samples N.
    pub fn samples(&self) -> usize {
        self.rows.len()
    }
}

/// Trials below this number are cut into blocks of time.
const FEW_TRIALS: usize = 6;

/// Number of blocks that a few trials are cut into, in all.
const BLOCKS: usize = 12;

/// Number of pieces of time in a block.
const PIECES: usize = 5;

/// Numbers the blocks that are left out one at a time: trials, or regions of few trials. Returns whether they are trials.
///
/// A region consists of pieces of time with similar actuator values, so that leaving it out tests extrapolation in the actuators, and not
/// only in time.
pub fn number_blocks(series: &mut [Series]) -> bool {
    if series.len() >= FEW_TRIALS {
        series.iter_mut().enumerate().for_each(|(b, series)| series.block.fill(b));
        return true;
    }
    let total: usize = series.iter().map(Series::samples).sum();
    let mut next = 0;
    for series in series {
        let share = (BLOCKS * series.samples()) as f64 / total.max(1) as f64;
        let regions = (share.round() as usize).clamp(2, (series.samples() / PIECES).max(2));
        let pieces = (regions * PIECES).min(series.samples());
        let piece_of = |k: usize| k * pieces / series.samples();
        let region = regions_of(&piece_means(series, pieces), regions);
        series.block = (0..series.samples()).map(|k| next + region[piece_of(k)]).collect();
        next += regions;
    }
    false
}

/// Returns the mean of each actuator in each piece, standardised over the trial.
fn piece_means(series: &Series, pieces: usize) -> Vec<Vec<f64>> {
    let samples = series.samples();
    let mut means = vec![vec![0.0; series.thin.actuators.len()]; pieces];
    for (a, q) in series.thin.actuators.iter().enumerate() {
        let mean = q.iter().sum::<f64>() / samples as f64;
        let spread = (q.iter().map(|q| (q - mean).powi(2)).sum::<f64>() / samples as f64).sqrt();
        let mut counts = vec![0usize; pieces];
        for (k, q) in q.iter().enumerate() {
            let piece = k * pieces / samples;
            means[piece][a] += if spread > 0.0 { (q - mean) / spread } else { 0.0 };
            counts[piece] += 1;
        }
        means.iter_mut().zip(&counts).for_each(|(mean, count)| mean[a] /= (*count).max(1) as f64);
    }
    means
}

/// Returns regions of equal size: a region begins at the free piece farthest from the middle, and takes those nearest
/// to it.
fn regions_of(points: &[Vec<f64>], regions: usize) -> Vec<usize> {
    let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let mut region = vec![regions - 1; points.len()];
    let mut free: Vec<usize> = (0..points.len()).collect();
    for r in 0..regions {
        let take = free.len() / (regions - r);
        let zero = vec![0.0; points.first().map_or(0, Vec::len)];
        let far = |&&a: &&usize, &&b: &&usize| {
            distance(&points[a], &zero).total_cmp(&distance(&points[b], &zero)).then(b.cmp(&a))
        };
        let Some(&seed) = free.iter().max_by(far) else { break };
        free.sort_by(|&a, &b| {
            let from = |k: usize| distance(&points[k], &points[seed]);
            from(a).total_cmp(&from(b)).then(a.cmp(&b))
        });
        free.drain(..take).for_each(|k| region[k] = r);
        free.sort_unstable();
    }
    region
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: three distinct groups of points, alternating in time.
    #[test]
    fn regions_follow_the_actuators_and_not_the_clock() {
        let points: Vec<Vec<f64>> = (0..15).map(|k| vec![[-5.0, 0.0, 5.0][k % 3] + 0.01 * k as f64]).collect();
        let region = regions_of(&points, 3);
        for k in 3..15 {
            assert_eq!(region[k], region[k - 3], "{region:?}");
        }
        assert_eq!(region.iter().filter(|r| **r == 0).count(), 5);
    }

    /// Oracle: by hand. Of 13 samples every second is looked at; of the record every second stays, of what is looked at every
    /// third.
    #[test]
    fn a_decimated_trial_has_the_same_samples_in_fewer() {
        let time: Vec<f64> = (0..13).map(f64::from).collect();
        let record = Record::new(time.clone(), vec![time.iter().map(|t| 10.0 * t).collect()], vec![], vec![]);
        let measured = DMatrix::from_fn(13, 2, |t, o| (100 * t + o) as f64);
        let trial = Trial { name: String::new(), record, lead: None, measured, predicted: None, offset: None };
        let decimated = Series::new(&trial, 2).decimated(2, 3);
        assert_eq!(decimated.record.time, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0]);
        assert_eq!(decimated.rows, [0, 3, 6]);
        assert_eq!(decimated.thin.actuators[0], [0.0, 60.0, 120.0]);
        assert_eq!(decimated.measured, [0.0, 1.0, 600.0, 601.0, 1200.0, 1201.0]);
        // The warm-up is 6 % of 12 s.
        assert_eq!(decimated.counts, [false, true, true]);
    }

    /// Oracle: by hand. Samples 0, 3 and 4 of 9 were not measured: every second of the others is compared, on the whole record.
    #[test]
    fn samples_without_an_output_stay_in_the_record() {
        let time: Vec<f64> = (0..9).map(f64::from).collect();
        let record = Record::new(time.clone(), vec![time.clone()], vec![], vec![]);
        let measured = DMatrix::from_fn(9, 1, |t, _| if [0, 3, 4].contains(&t) { f64::NAN } else { t as f64 });
        let trial = Trial { name: String::new(), record, lead: None, measured, predicted: None, offset: None };
        let series = Series::new(&trial, 2);
        assert_eq!(
            (series.rows.as_slice(), series.measured.as_slice()),
            ([1, 5, 7].as_slice(), [1.0, 5.0, 7.0].as_slice())
        );
        assert_eq!((series.record.samples(), series.is_led), (9, false));
        let decimated = series.decimated(4, 2);
        assert_eq!(decimated.record.time, [0.0, 1.0, 4.0, 7.0, 8.0]);
        assert_eq!(
            (decimated.rows.as_slice(), decimated.measured.as_slice()),
            ([1, 3].as_slice(), [1.0, 7.0].as_slice())
        );
    }
}
