//! Sequences of unequal length, with the time between their steps, for benchmarks of irregular sampling.
//!
//! | symbol    | meaning                                                   | shape                |
//! | --------- | --------------------------------------------------------- | -------------------- |
//! | `inputs`  | what is seen at each step                                 | [T×C]                |
//! | `elapsed` | time since the previous step, in the unit of the source     | `[T]`                  |
//! | `targets` | what is asked: after the last step, or after every one    | [1×O] or [T×O]       |
//!
//! A sequence stands in one of three parts: one is learned from, one chooses the epoch, one is looked at once, at the end.
//! [`bit_stream`] makes sequences, [`table`] reads them.

pub mod bit_stream;
pub mod table;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Steps that are asked about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// The last one of each sequence.
    Last,
    /// Every one.
    Every,
}

/// One sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    /// Name in the source.
    pub name: String,
    /// `[T]`.
    pub elapsed: Vec<f64>,
    /// [T×C].
    pub inputs: DMatrix<f64>,
    /// [1×O] where the last step is asked about, else [T×O].
    pub targets: DMatrix<f64>,
}

/// All sequences of a source.
#[derive(Debug, Clone, PartialEq)]
pub struct SequenceSet {
    /// Names of the inputs.
    pub channels: Vec<String>,
    /// Names of the targets.
    pub outputs: Vec<String>,
    /// Steps that are asked about.
    pub asked: Asked,
    /// Learned from.
    pub training: Vec<Sequence>,
    /// Chooses the epoch.
    pub validation: Vec<Sequence>,
    /// Looked at once.
    pub test: Vec<Sequence>,
}

impl Sequence {
    /// T.
    pub fn steps(&self) -> usize {
        self.elapsed.len()
    }
}

impl SequenceSet {
    /// The parts by name.
    pub fn parts(&self) -> [(&'static str, &[Sequence]); 3] {
        [("training", &self.training), ("validation", &self.validation), ("test", &self.test)]
    }

    /// SHA-256 over names and numbers of all parts, in hexadecimal.
    pub fn hash(&self) -> String {
        let mut hash = Sha256::new();
        for name in self.channels.iter().chain(&self.outputs) {
            text(&mut hash, name);
        }
        for (name, sequences) in self.parts() {
            text(&mut hash, name);
            for sequence in sequences {
                text(&mut hash, &sequence.name);
                hash.update((sequence.steps() as u64).to_le_bytes());
                let numbers = sequence.elapsed.iter().chain(&sequence.inputs).chain(&sequence.targets);
                numbers.for_each(|number| hash.update(number.to_le_bytes()));
            }
        }
        acm_hashed::hexadecimal(&hash.finalize())
    }
}

fn text(hash: &mut Sha256, name: &str) {
    hash.update((name.len() as u64).to_le_bytes());
    hash.update(name.as_bytes());
}
