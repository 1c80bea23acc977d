//! What the candidates of a choice are judged by: the validation part, sequence by sequence.
//!
//! ```text
//! numbers   e_s = Σ (p − t)² / n_s          over all outputs and steps of sequence s, in the square of the targets' unit
//! labels    e_s = mean cross-entropy, in nats
//! ```
//!
//! Windows of one sequence count as one.

use std::collections::BTreeMap;

use acm_datasets::sequences::{Sequence, table::whole};
use nalgebra::DMatrix;

use crate::config::Loss;
use crate::run::sequences::{scores::targets, units::error};
use crate::schedule::study::fold_errors::FoldErrors;

/// Targets of some sequences.
#[derive(Debug)]
pub struct Judged {
    loss: Loss,
    targets: DMatrix<f64>,
    /// Rows of each whole sequence.
    rows: Vec<Vec<usize>>,
}

impl Judged {
    /// Returns the targets of the sequences of one part.
    pub fn new(sequences: &[Sequence], loss: Loss) -> Self {
        let mut rows: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        let mut row = 0;
        for sequence in sequences {
            let count = sequence.targets.nrows();
            rows.entry(whole(&sequence.name)).or_default().extend(row..row + count);
            row += count;
        }
        Self { loss, targets: targets(sequences), rows: rows.into_values().collect() }
    }

    /// Returns whether other sequences have the same targets.
    pub fn same(&self, other: &Self) -> bool {
        self.loss == other.loss && self.targets == other.targets && self.rows == other.rows
    }

    /// Returns the number of sequences.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Returns the error of predictions [N×O] on each sequence.
    pub fn errors(&self, predicted: &DMatrix<f64>) -> FoldErrors {
        let of = |rows: &Vec<usize>| {
            let outputs = self.targets.ncols();
            let each = rows.iter().flat_map(|&row| (0..outputs).map(move |o| (row, o)));
            let sum: f64 = each.map(|place| error(self.loss, self.targets[place], predicted[place])).sum();
            sum / (rows.len() * outputs) as f64
        };
        FoldErrors(self.rows.iter().map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sequence(name: &str, targets: &[f64]) -> Sequence {
        Sequence {
            name: name.into(),
            elapsed: vec![1.0; targets.len() / 2],
            inputs: DMatrix::zeros(targets.len() / 2, 1),
            targets: DMatrix::from_row_slice(targets.len() / 2, 2, targets),
        }
    }

    /// Oracle: by hand. Both windows of a err by 1 and 2 on the first output; b by 3 on the second of two steps.
    #[test]
    fn errors_are_means_over_whole_sequences() {
        let sequences = [
            sequence("a from step 1", &[0.0, 0.0]),
            sequence("b", &[0.0, 0.0, 0.0, 0.0]),
            sequence("a from step 9", &[0.0, 0.0]),
        ];
        let judged = Judged::new(&sequences, Loss::MeanSquare);
        let predicted = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 0.0, 0.0, 0.0, 3.0, 2.0, 0.0]);
        assert_eq!(judged.errors(&predicted).0, [5.0 / 4.0, 9.0 / 4.0]);
        assert_eq!(judged.count(), 2);
        assert!(judged.same(&Judged::new(&sequences, Loss::MeanSquare)));
        assert!(!judged.same(&Judged::new(&sequences[..2], Loss::MeanSquare)));
    }
}
