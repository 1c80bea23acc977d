//! Input of a pass, and its division into shards.
//!
//! | symbol | meaning                                  |
//! | ------ | ---------------------------------------- |
//! | `B`    | sequences                                |
//! | `W`    | steps of each                            |
//! | `C, O` | channels, predictions of a step          |
//!
//! A recurrent body takes [`ROWS`] sequences a shard, side by side, and walks over the steps. A perceptron
//! needs no order: its shard is a few blocks of [`ROWS`] samples, which it walks over instead. Lanes without
//! a sample are filled with zeros, and their derivative is zero.

use crate::bodies::network::Source;
use crate::shape::{Body, Keep, Shape};
use crate::vectors::row::{ROWS, Row};

/// A batch of sequences.
#[derive(Clone, Copy, Debug)]
pub struct Sequences<'a> {
    /// Channels, `[B,W,C]`.
    pub inputs: &'a [f32],
    /// Time since the previous step in s, `[B,W]`.
    pub elapsed: &'a [f32],
    /// First state, `[layers,B,H]`; zeros if `None`.
    pub state: Option<&'a [f32]>,
    /// Number of sequences B.
    pub batch: usize,
    /// Number of time steps W.
    pub steps: usize,
    /// Steps that are predicted.
    pub keep: Keep,
}

/// Blocks of [`ROWS`] samples in a shard of a perceptron. They are enough to outweigh the overhead of a sum of
/// products, and few enough to leave several shards to several cores.
const BLOCKS: usize = 4;

/// Division of a batch into shards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deal {
    /// Samples in all: sequences, or single rows for a perceptron.
    pub samples: usize,
    /// Samples in a shard.
    pub per_shard: usize,
    /// Predictions made of a sample.
    pub per_sample: usize,
    recurrent: bool,
}

impl Deal {
    /// Divides a batch into the shards of a network.
    pub fn new(shape: &Shape, sequences: &Sequences) -> Self {
        let Sequences { batch, steps, keep, .. } = *sequences;
        let kept = if keep == Keep::Every { steps } else { 1 };
        if matches!(shape.body, Body::Mlp(_)) {
            let (samples, per_sample) = (batch * kept, shape.outputs);
            return Self { samples, per_shard: BLOCKS * ROWS, per_sample, recurrent: false };
        }
        Self { samples: batch, per_shard: ROWS, per_sample: kept * shape.outputs, recurrent: true }
    }

    /// Returns the number of shards.
    pub fn shards(&self) -> usize {
        self.samples.div_ceil(self.per_shard)
    }

    /// Returns the number of predictions of a full shard.
    pub fn predictions_per_shard(&self) -> usize {
        self.per_shard * self.per_sample
    }

    /// Returns the number of the batch's B·W steps that a full shard reads from.
    pub fn places_per_shard(&self, sequences: &Sequences) -> usize {
        let every_sample = !self.recurrent && sequences.keep == Keep::Every;
        if every_sample { self.per_shard } else { self.per_shard * sequences.steps }
    }

    /// Returns the number of predictions of the batch.
    pub fn predictions(&self) -> usize {
        self.samples * self.per_sample
    }

    /// Returns the number of steps of a full shard.
    pub fn slots(&self, sequences: &Sequences) -> usize {
        if self.recurrent { sequences.steps } else { BLOCKS }
    }
}

/// The samples of one shard.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lot<'a> {
    sequences: &'a Sequences<'a>,
    channels: usize,
    recurrent: bool,
    first: usize,
    count: usize,
}

impl<'a> Lot<'a> {
    /// Returns the samples of shard number `shard`.
    pub fn new(shape: &Shape, sequences: &'a Sequences<'a>, deal: &Deal, shard: usize) -> Self {
        let first = shard * deal.per_shard;
        let count = deal.per_shard.min(deal.samples - first);
        Self { sequences, channels: shape.inputs, recurrent: deal.recurrent, first, count }
    }

    /// Returns the number of steps of the shard.
    pub fn slots(&self) -> usize {
        if self.recurrent { self.sequences.steps } else { self.count.div_ceil(ROWS) }
    }

    /// Returns the number of samples.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the slots that are predicted: all, or the last.
    pub fn kept(&self) -> std::ops::Range<usize> {
        let all = !self.recurrent || self.sequences.keep == Keep::Every;
        if all { 0..self.slots() } else { self.slots() - 1..self.slots() }
    }

    /// Returns the number of lanes of a slot that hold a sample.
    fn lanes(&self, slot: usize) -> usize {
        if self.recurrent { self.count } else { ROWS.min(self.count - slot * ROWS) }
    }

    /// Returns the index of (slot, lane) among the B·W steps of the batch.
    fn place(&self, slot: usize, lane: usize) -> usize {
        let steps = self.sequences.steps;
        if self.recurrent {
            return (self.first + lane) * steps + slot;
        }
        let sample = self.first + slot * ROWS + lane;
        if self.sequences.keep == Keep::Every { sample } else { (sample + 1) * steps - 1 }
    }

    /// Returns the index of (slot, lane) among the predicted steps of the shard.
    fn answer(&self, slot: usize, lane: usize) -> usize {
        match (self.recurrent, self.sequences.keep) {
            (true, Keep::Last) => lane,
            (true, Keep::Every) => lane * self.sequences.steps + slot,
            (false, _) => slot * ROWS + lane,
        }
    }

    /// Returns the number of the batch's B·W steps that belong to the shards before.
    pub fn places_before(&self) -> usize {
        let every_sample = !self.recurrent && self.sequences.keep == Keep::Every;
        if every_sample { self.first } else { self.first * self.sequences.steps }
    }

    /// Copies rows of the channels at a slot to the shard's own part of `[B,W,C]`.
    #[inline(always)]
    pub fn scatter_inputs(&self, slot: usize, rows: &[Row], inputs: &mut [f32]) {
        for lane in 0..self.lanes(slot) {
            let place = self.place(slot, lane) - self.places_before();
            empty(rows, lane, &mut inputs[place * self.channels..][..self.channels]);
        }
    }

    /// Copies rows of a layer's state to `[layers,B,H]`.
    pub fn scatter_state(&self, layer: usize, rows: &[Row], state: &mut [f32]) {
        for lane in 0..self.lanes(0) {
            let sample = layer * self.sequences.batch + self.first + lane;
            empty(rows, lane, &mut state[sample * rows.len()..][..rows.len()]);
        }
    }

    /// Copies a layer's state of `[layers,B,H]` to rows, or fills them with zeros.
    #[inline(always)]
    pub fn gather_state(&self, layer: usize, state: Option<&[f32]>, rows: &mut [Row]) {
        let (width, lanes) = (rows.len(), self.lanes(0));
        let Some(state) = state else { return rows.fill(Row::ZERO) };
        for lane in 0..lanes {
            let sample = layer * self.sequences.batch + self.first + lane;
            fill(rows, lane, &state[sample * width..][..width]);
        }
        clear(rows, lanes);
    }

    /// Copies rows of a slot to predictions of the shard.
    #[inline(always)]
    pub fn scatter(&self, slot: usize, rows: &[Row], predictions: &mut [f32]) {
        for lane in 0..self.lanes(slot) {
            empty(rows, lane, &mut predictions[self.answer(slot, lane) * rows.len()..][..rows.len()]);
        }
    }

    /// Copies predictions of the shard, or their derivatives, to rows of a slot.
    #[inline(always)]
    pub fn gather(&self, slot: usize, predictions: &[f32], rows: &mut [Row]) {
        let width = rows.len();
        for lane in 0..self.lanes(slot) {
            fill(rows, lane, &predictions[self.answer(slot, lane) * width..][..width]);
        }
        clear(rows, self.lanes(slot));
    }
}

impl Source for Lot<'_> {
    #[inline(always)]
    fn inputs(&self, slot: usize, rows: &mut [Row]) {
        for lane in 0..self.lanes(slot) {
            fill(rows, lane, &self.sequences.inputs[self.place(slot, lane) * self.channels..][..self.channels]);
        }
        clear(rows, self.lanes(slot));
    }

    #[inline(always)]
    fn elapsed(&self, slot: usize, row: &mut Row) {
        for lane in 0..self.lanes(slot) {
            row.0[lane] = self.sequences.elapsed[self.place(slot, lane)];
        }
        row.0[self.lanes(slot)..].fill(0.0);
    }

    #[inline(always)]
    fn state(&self, layer: usize, rows: &mut [Row]) {
        self.gather_state(layer, self.sequences.state, rows);
    }
}

/// Fills one lane of the rows.
#[inline(always)]
fn fill(rows: &mut [Row], lane: usize, values: &[f32]) {
    for (row, &value) in rows.iter_mut().zip(values) {
        row.0[lane] = value;
    }
}

/// Copies the rows' values in one lane.
#[inline(always)]
fn empty(rows: &[Row], lane: usize, values: &mut [f32]) {
    for (value, row) in values.iter_mut().zip(rows) {
        *value = row.0[lane];
    }
}

/// Fills the lanes from `first` on with zeros.
#[inline(always)]
fn clear(rows: &mut [Row], first: usize) {
    if first < ROWS {
        rows.iter_mut().for_each(|row| row.0[first..].fill(0.0));
    }
}
