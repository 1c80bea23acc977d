//! Gradient-boosted trees on the inputs of some of the last steps.
//!
//! ```text
//! p_k = b_k + forest(φ_k)        φ_k = (x_{k−l}, Δt_{k−l}  for l in 0, 1, 2, 4, 8;  means of x and Δt up to k)
//! ```
//!
//! b_k is the last value of each target where that is the prediction without a network, else 0. Labels have logits, without b_k.
//! The number of rounds is chosen on the validation part ([`forest`](crate::learn::baseline::forest)). Of parts with more than
//! [`MOST_STEPS`] steps as many are taken, evenly spaced.

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use super::constant::Constant;
use super::features::Inputs;
use crate::config::{Loss, TreesConfig};
use crate::learn::LearnError;
use crate::learn::baseline::forest::{Forest, Table};
use crate::run::sequences::scores::targets;

/// Lags of the inputs.
const LAGS: [usize; 5] = [0, 1, 2, 4, 8];

/// Largest number of steps of a part that trees are grown on.
const MOST_STEPS: usize = 20_000;

/// Smallest number of steps in a leaf: this part of all of them, from 2 to 20.
const LEAF: usize = 200;

/// Fitted trees.
#[derive(Debug)]
pub struct Trees {
    without: Constant,
    inputs: Inputs,
    forest: Forest,
}

impl Trees {
    /// Grows the trees. `without` is the prediction without a network.
    ///
    /// # Errors
    /// Numbers that trees cannot be grown from.
    pub fn fit(set: &SequenceSet, without: &Constant, loss: Loss) -> Result<Self, LearnError> {
        let inputs = Inputs::of(&set.training);
        let part = |sequences: &[Sequence]| {
            let wanted = targets(sequences) - without.last(sequences);
            let rows = spread(wanted.nrows());
            Table::new(features(&inputs, sequences).select_rows(&rows), wanted.select_rows(&rows))
        };
        let (seen, unseen) = (part(&set.training), part(&set.validation));
        let leaf_windows = (seen.len() / LEAF).clamp(2, TreesConfig::default().leaf_windows);
        let config = TreesConfig { leaf_windows, ..TreesConfig::default() };
        let forest = Forest::grow(&config, loss, &seen, &unseen)?;
        Ok(Self { without: without.clone(), inputs, forest })
    }

    /// Returns the number of its leaves.
    pub fn numbers(&self) -> usize {
        self.forest.leaves()
    }

    /// Returns its predictions for sequences [N×O].
    pub fn predict(&self, sequences: &[Sequence]) -> DMatrix<f64> {
        self.without.last(sequences) + self.forest.predict(&features(&self.inputs, sequences))
    }
}

/// Returns up to [`MOST_STEPS`] of `count` places, evenly spaced.
fn spread(count: usize) -> Vec<usize> {
    let taken = count.min(MOST_STEPS);
    (0..taken).map(|place| place * count / taken).collect()
}

/// Returns the features of all steps with targets, row after row.
fn features(inputs: &Inputs, sequences: &[Sequence]) -> DMatrix<f64> {
    let rows = sequences.iter().map(|one| one.targets.nrows()).sum();
    let width = LAGS.len() * inputs.width();
    let mut features = DMatrix::zeros(rows, width + inputs.width());
    let mut row = 0;
    for sequence in sequences {
        let (lagged, means) = (inputs.lagged(sequence, &LAGS), inputs.means(sequence));
        features.view_mut((row, 0), lagged.shape()).copy_from(&lagged);
        features.view_mut((row, width), means.shape()).copy_from(&means);
        row += lagged.nrows();
    }
    features
}

#[cfg(test)]
mod tests {
    use acm_datasets::sequences::Asked;

    use super::*;

    /// A sequence whose only label is whether the mean of its input is above 0.2.
    fn sequence(seed: usize) -> Sequence {
        let level = ((seed * 37) as f64).sin();
        let x: Vec<f64> = (0..9).map(|k| level + 3.0 * ((seed * 17 + k * 7) as f64).sin()).collect();
        let label = f64::from(x.iter().sum::<f64>() / 9.0 > 0.2);
        Sequence {
            name: format!("{seed}"),
            elapsed: vec![1.0; 9],
            inputs: DMatrix::from_column_slice(9, 1, &x),
            targets: DMatrix::from_element(1, 1, label),
        }
    }

    /// Oracle: a step of the mean, which no line of single inputs follows; on sequences that the trees were not grown on.
    #[test]
    fn a_step_of_the_mean_is_found() {
        let set = SequenceSet {
            channels: vec!["x".into()],
            outputs: vec!["y".into()],
            asked: Asked::Last,
            training: (0..400).map(sequence).collect(),
            validation: (400..600).map(sequence).collect(),
            test: (600..800).map(sequence).collect(),
        };
        let trees = Trees::fit(&set, &Constant::Number(vec![0.0]), Loss::CrossEntropy).unwrap();
        let (said, wanted) = (trees.predict(&set.test), targets(&set.test));
        let wrong = said.iter().zip(&wanted).filter(|(logit, label)| (**logit > 0.0) != (**label > 0.5)).count();
        assert!(wrong <= 8, "{wrong} of 200 are wrong");
        assert!(trees.numbers() > 1);
    }

    #[test]
    fn steps_are_spread_evenly() {
        assert_eq!(spread(3), [0, 1, 2]);
        let many = spread(50_000);
        assert_eq!((many.len(), many[1], many[MOST_STEPS - 1]), (MOST_STEPS, 2, 49_997));
        assert!(many.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
