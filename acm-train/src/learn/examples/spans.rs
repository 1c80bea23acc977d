//! Spans: runs of samples of unequal length through which a network carries its state from zero.
//!
//! | use        | a span is                                              | samples that are scored                          |
//! | ---------- | ------------------------------------------------------ | ------------------------------------------------ |
//! | training   | a piece of L samples; a whole segment where it is shorter | all from the B-th on; all of every eighth piece |
//! | prediction | a segment: from a gap, or the trial's start, to the next  | targets                                      |
//!
//! Pieces begin at every sample. The first B samples of a piece, its burn-in, lead the state up and are not scored. Every eighth
//! piece, among them that at the start of a segment, is scored from its first sample, so that the network also learns what to
//! answer after a start. Samples without an output are never scored.
//!
//! | symbol    | meaning                                       | shape     | unit |
//! | --------- | --------------------------------------------- | --------- | ---- |
//! | `inputs`  | channels, standardised; zeros in the padding  | `[B,W,C]` | –    |
//! | `elapsed` | time since the previous sample; zero in the padding | `[B,W]`   | s    |
//! | `targets` | residual, standardised, of which some count   | `[B,W,O]` | –    |
//!
//! W is the longest span of a batch. Padding stands behind all that counts, so it changes nothing.

use std::ops::Range;

use acm_datasets::{Series, Standardizer, Window};
use acm_models::Keep;
use sha2::{Digest, Sha256};

use super::Examples;
use super::batch::Batch;
use super::windows::{Columns, Scalers};
use crate::learn::correction::Widths;

/// One piece of so many is scored from its first sample.
const SCORED_WHOLE: usize = 8;

/// Largest number of spans that are predicted together: the kernels' width.
const TOGETHER: usize = 32;

/// Spans of the series of a part.
#[derive(Debug, Clone)]
pub struct Spans {
    scalers: Scalers,
    columns: Vec<Columns>,
    /// Whether each sample of each series is a target.
    targets: Vec<Vec<bool>>,
    spans: Vec<Span>,
}

/// One span.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Span {
    series: usize,
    rows: Range<usize>,
    /// First samples that are not scored.
    burn_in: usize,
}

impl Spans {
    /// Returns a set without series.
    pub fn empty(scalers: &Scalers) -> Self {
        Self { scalers: scalers.clone(), columns: vec![], targets: vec![], spans: vec![] }
    }

    /// Adds the pieces of a series for training: `length` samples, of which the first `burn_in` are not scored.
    pub fn push_pieces(&mut self, series: &Series, length: usize, burn_in: usize) {
        let index = self.push(series, (0..series.time.len()).map(|sample| series.is_measured(sample)).collect());
        let first = (0..series.time.len()).find(|sample| self.targets[index][*sample]).unwrap_or(0);
        for segment in series.segments.iter().filter(|segment| segment.end > first) {
            // What is before the first output, such as the past of a block, leads the state up.
            let segment = segment.start.max(first.saturating_sub(burn_in))..segment.end;
            let count = (segment.len() + 1).saturating_sub(length).max(1);
            self.spans.extend((0..count).map(|k| {
                let start = segment.start + k;
                let burn_in = if k % SCORED_WHOLE == 0 { 0 } else { burn_in };
                Span { series: index, rows: start..segment.end.min(start + length), burn_in }
            }));
        }
    }

    /// Adds the whole segments of a series for prediction at the ends of `targets`.
    pub fn push_segments(&mut self, series: &Series, targets: impl IntoIterator<Item = Window>) {
        let mut is_target = vec![false; series.time.len()];
        targets.into_iter().for_each(|target| is_target[target.end] = true);
        let index = self.push(series, is_target);
        self.spans.extend(series.segments.iter().map(|rows| Span { series: index, rows: rows.clone(), burn_in: 0 }));
    }

    fn push(&mut self, series: &Series, targets: Vec<bool>) -> usize {
        self.columns.push(Columns::new(series, &self.scalers));
        self.targets.push(targets);
        self.columns.len() - 1
    }

    fn widths(&self) -> Widths {
        Widths { outputs: self.outputs(), actuators: self.scalers.actuators.len() }
    }
}

impl Examples for Spans {
    fn len(&self) -> usize {
        self.spans.len()
    }

    fn channels(&self) -> usize {
        self.scalers.inputs.mean.len()
    }

    fn outputs(&self) -> usize {
        self.scalers.targets.mean.len()
    }

    fn said(&self) -> usize {
        self.widths().said()
    }

    /// Neighbours of like length, so that little is padded.
    fn batches(&self) -> Vec<Range<usize>> {
        let (mut batches, mut first) = (vec![], 0);
        while first < self.spans.len() {
            let length = self.spans[first].rows.len();
            let alike = |span: &&Span| span.rows.len() <= 2 * length && length <= 2 * span.rows.len();
            let count = self.spans[first..].iter().take(TOGETHER).take_while(alike).count();
            batches.push(first..first + count);
            first += count;
        }
        batches
    }

    fn gather(&self, chosen: &[usize], _supervise: Keep, batch: &mut Batch) {
        let (channels, outputs, widths) = (self.channels(), self.outputs(), self.widths());
        let sloped = outputs * widths.actuators;
        let steps = chosen.iter().map(|&index| self.spans[index].rows.len()).max().unwrap_or(1);
        (batch.steps, batch.supervise, batch.widths) = (steps, Keep::Every, widths);
        let Batch { inputs, elapsed, targets, slopes, counted, .. } = batch;
        [&mut *inputs, &mut *elapsed, &mut *targets, &mut *slopes].into_iter().for_each(Vec::clear);
        counted.clear();
        for (place, &index) in chosen.iter().enumerate() {
            let (Span { series, rows, burn_in }, end) = (&self.spans[index], (place + 1) * steps);
            let columns = &self.columns[*series];
            let wide = |width: usize| rows.start * width..rows.end * width;
            append(inputs, &columns.inputs[wide(channels)], end * channels);
            append(elapsed, &columns.elapsed[rows.clone()], end);
            append(targets, &columns.targets[wide(outputs)], end * outputs);
            append(slopes, &columns.slopes[wide(sloped)], end * sloped);
            for row in rows.clone() {
                let counts = row >= rows.start + burn_in && self.targets[*series][row];
                counted.extend(std::iter::repeat_n(counts, outputs));
            }
            counted.resize(end * outputs, false);
        }
    }

    fn carry_state(&self) -> bool {
        true
    }

    fn residual(&self) -> Option<&Standardizer> {
        Some(&self.scalers.targets)
    }

    fn whose(&self, index: usize) -> String {
        format!("trial {}", self.columns[self.spans[index].series].trial)
    }

    fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        self.columns.iter().for_each(|columns| columns.hash(&mut hash));
        for Span { series, rows, burn_in } in &self.spans {
            [*series, rows.start, rows.end, *burn_in].iter().for_each(|n| hash.update((*n as u64).to_le_bytes()));
        }
        for targets in &self.targets {
            targets.iter().for_each(|target| hash.update([u8::from(*target)]));
        }
        acm_hashed::hexadecimal(&hash.finalize())
    }
}

/// Appends values, and zeros up to `end`.
fn append(all: &mut Vec<f32>, values: &[f32], end: usize) {
    all.extend_from_slice(values);
    all.resize(end, 0.0);
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    /// Two segments, of 5 and 2 samples; sample 1 has no output. Channel and target of sample k are k.
    fn series() -> Series {
        let numbers = DMatrix::from_fn(7, 1, |k, _| k as f64);
        let measured = DMatrix::from_fn(7, 1, |k, _| if k == 1 { f64::NAN } else { k as f64 });
        Series {
            trial: "a".into(),
            time: vec![0.0, 1.0, 2.0, 3.0, 4.0, 9.0, 10.0],
            elapsed: vec![1.0; 7],
            inputs: numbers,
            target: measured.clone(),
            nominal: DMatrix::zeros(7, 1),
            measured,
            segments: vec![0..5, 5..7],
            slopes: DMatrix::zeros(7, 0),
        }
    }

    fn scalers() -> Scalers {
        let plain = || Standardizer { mean: vec![0.0], spread: vec![1.0] };
        Scalers { inputs: plain(), targets: plain(), actuators: vec![], straight: None }
    }

    /// Oracle: by hand. Pieces of 3: 0–2, 1–3, 2–4 of the first segment, and the whole second.
    #[test]
    fn pieces_are_scored_behind_their_burn_in() {
        let mut spans = Spans::empty(&scalers());
        spans.push_pieces(&series(), 3, 2);
        let mut batch = Batch::default();
        spans.gather(&[0, 1, 3], Keep::Last, &mut batch);
        assert_eq!(batch.inputs, [0.0, 1.0, 2.0, 1.0, 2.0, 3.0, 5.0, 6.0, 0.0]);
        assert_eq!(batch.counted, [true, false, true, false, false, true, true, true, false]);
        assert_eq!((spans.len(), batch.steps, batch.elapsed[8]), (4, 3, 0.0));
    }

    /// Oracle: by hand. Targets 2, 4 and 6; segments of 5 and 2 samples are no neighbours of like length.
    #[test]
    fn segments_are_predicted_at_their_targets() {
        let mut spans = Spans::empty(&scalers());
        spans.push_segments(&series(), [2, 4, 6].map(|end| Window { series: 0, end }));
        assert_eq!(spans.batches(), [0..1, 1..2]);
        let mut batch = Batch::default();
        spans.gather(&[0], Keep::Last, &mut batch);
        let [predicted, wanted] = batch.scored(&[0.5, 1.5, 2.5, 3.5, 4.5]);
        assert_eq!((&*predicted, &*wanted), (&[2.5, 4.5][..], &[2.0, 4.0][..]));
    }
}
