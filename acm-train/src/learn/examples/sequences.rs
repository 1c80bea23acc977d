//! Sequences of unequal length as examples, padded batch by batch.
//!
//! | symbol    | meaning                                       | shape   | unit |
//! | --------- | --------------------------------------------- | ------- | ---- |
//! | `inputs`  | channels, standardised; zeros in the padding  | `[B,W,C]` | –    |
//! | `elapsed` | time since the previous step; zero there        | `[B,W]`   | s    |
//! | `targets` | at every step, of which some count            | `[B,W,O]` | –    |
//!
//! W is the longest sequence of the batch. Within each [`POOL`] batches of a shuffled epoch, sequences of like length go into
//! one batch, and the batches keep no order of length. Padding stands at the end, after all that counts, so it changes nothing: a
//! network does not look ahead, and what does not count has no derivative.

use acm_datasets::sequences::Sequence;
use acm_models::{Engine, Keep, Network};
use nalgebra::DMatrix;
use sha2::{Digest, Sha256};

use super::Examples;
use super::batch::Batch;
use super::learned::Learned;
use super::order::order;
use super::single::{by_rows, single};
use crate::config::{Elapsed, Loss};
use crate::learn::fit::evaluate::walk;

/// Number of batches among which sequences are sorted by length.
const POOL: usize = 32;

/// The sequences of one part.
#[derive(Debug, Clone)]
pub struct SequenceExamples {
    loss: Loss,
    channels: usize,
    outputs: usize,
    rows: Vec<Rows>,
}

/// One sequence in single precision, row after row; targets belong to its last rows.
#[derive(Debug, Clone)]
struct Rows {
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    targets: Vec<f32>,
}

impl SequenceExamples {
    /// Returns the sequences of one part; `learned` comes from the training part.
    pub fn new(sequences: &[Sequence], learned: &Learned, elapsed: Elapsed) -> Self {
        let (channels, outputs) = (learned.scalers.inputs.mean.len(), learned.scalers.targets.mean.len());
        let rows = sequences.iter().map(|one| Rows::new(one, learned, elapsed)).collect();
        Self { loss: learned.loss, channels, outputs, rows }
    }
}

impl Rows {
    fn new(sequence: &Sequence, learned: &Learned, elapsed: Elapsed) -> Self {
        let scalers = &learned.scalers;
        Self {
            inputs: by_rows(&scalers.inputs.standardize(&sequence.inputs)),
            elapsed: match elapsed {
                Elapsed::Measured => single(&sequence.elapsed),
                Elapsed::One => vec![1.0; sequence.steps()],
            },
            targets: by_rows(&scalers.targets.standardize(&learned.targets(sequence))),
        }
    }
}

/// Returns the predictions at the steps that count, standardised, row after row: [N×O].
pub fn predict(network: &Network, examples: &SequenceExamples) -> DMatrix<f64> {
    let mut all = vec![];
    walk(&mut Engine::new(network), &network.values(), examples, |predictions, batch| {
        let counted = predictions.iter().zip(&batch.counted).filter(|(_, counted)| **counted);
        all.extend(counted.map(|(prediction, _)| f64::from(*prediction)));
    });
    DMatrix::from_row_iterator(all.len() / examples.outputs, examples.outputs, all)
}

impl Examples for SequenceExamples {
    fn len(&self) -> usize {
        self.rows.len()
    }

    fn channels(&self) -> usize {
        self.channels
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn arrange(&self, mut shuffled: Vec<usize>, batch: usize) -> Vec<usize> {
        let mut arranged = Vec::with_capacity(shuffled.len());
        for pool in shuffled.chunks_mut(POOL * batch) {
            let first = pool[0] as u64;
            pool.sort_by_key(|&index| self.rows[index].elapsed.len());
            // A batch that is not full stays at the end, where the epoch is cut.
            let (full, rest) = pool.split_at(pool.len() / batch * batch);
            let turns = order(full.len() / batch, first, 0);
            arranged.extend(turns.into_iter().flat_map(|turn| &full[turn * batch..(turn + 1) * batch]));
            arranged.extend_from_slice(rest);
        }
        arranged
    }

    fn gather(&self, chosen: &[usize], _supervise: Keep, batch: &mut Batch) {
        let steps = chosen.iter().map(|&index| self.rows[index].elapsed.len()).max().unwrap_or(1);
        (batch.steps, batch.supervise, batch.loss) = (steps, Keep::Every, self.loss);
        let Batch { inputs, elapsed, targets, counted, .. } = batch;
        [&mut *inputs, &mut *elapsed, &mut *targets].into_iter().for_each(Vec::clear);
        counted.clear();
        for (place, rows) in chosen.iter().map(|&index| &self.rows[index]).enumerate() {
            let (end, asked) = ((place + 1) * steps, (place * steps + rows.elapsed.len()) * self.outputs);
            inputs.extend_from_slice(&rows.inputs);
            inputs.resize(end * self.channels, 0.0);
            elapsed.extend_from_slice(&rows.elapsed);
            elapsed.resize(end, 0.0);
            targets.resize(asked - rows.targets.len(), 0.0);
            targets.extend_from_slice(&rows.targets);
            targets.resize(end * self.outputs, 0.0);
            counted.resize(asked - rows.targets.len(), false);
            counted.resize(asked, true);
            counted.resize(end * self.outputs, false);
        }
    }

    fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        hash.update([u8::from(self.loss == Loss::CrossEntropy)]);
        for rows in &self.rows {
            for values in [&rows.inputs, &rows.elapsed, &rows.targets] {
                hash.update((values.len() as u64).to_le_bytes());
                values.iter().for_each(|value| hash.update(value.to_le_bytes()));
            }
        }
        acm_hashed::hexadecimal(&hash.finalize())
    }
}
