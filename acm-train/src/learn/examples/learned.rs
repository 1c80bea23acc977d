//! Targets of a network on sequences: values or differences to the last value seen, divided by a spread.
//!
//! ```text
//! r = t                      nominal = "none"            z_o = (r_o − mean_o) / s_o
//! r = t − u                  nominal = "persistence"     s_o = spread_o                    scale = "each"
//!                                                        s_o = √(Σ_o spread_o² / O)        scale = "together"
//! ```
//!
//! | symbol        | meaning                                          | shape |
//! | ------------- | ------------------------------------------------ | ----- |
//! | `t`           | targets                                          | [T×O] |
//! | `u`           | the inputs of the same names, at the same steps  | [T×O] |
//! | mean, spread  | of r over the training part                      | [O]   |
//!
//! With one spread for all, the mean of z² is in proportion to the mean square error in the targets' own unit.

use std::borrow::Cow;

use acm_datasets::Standardizer;
use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use super::windows::Scalers;
use crate::config::{Loss, Persistence, Scale};

/// Targets of learning, and their scaling.
#[derive(Debug, Clone)]
pub struct Learned {
    /// Loss function.
    pub loss: Loss,
    /// Scalers of the inputs and of r.
    pub scalers: Scalers,
    /// Index of each target among the inputs; none where nothing is subtracted.
    places: Option<Vec<usize>>,
}

impl Learned {
    /// Returns the scalers from the training part of a set.
    ///
    /// # Panics
    /// If persistence is requested and a target is no input.
    pub fn new(set: &SequenceSet, loss: Loss, nominal: Persistence, scale: Scale) -> Self {
        let place = |output: &String| set.channels.iter().position(|channel| channel == output);
        let places = (nominal == Persistence::Persistence)
            .then(|| set.outputs.iter().map(|output| place(output).expect("validated: targets are seen")).collect());
        let inputs = Standardizer::fit(&set.training.iter().map(|one| &one.inputs).collect::<Vec<_>>());
        let labels = Standardizer { mean: vec![0.0; set.outputs.len()], spread: vec![1.0; set.outputs.len()] };
        let mut learned =
            Self { loss, scalers: Scalers { inputs, targets: labels, actuators: vec![], straight: None }, places };
        if loss == Loss::MeanSquare {
            let all: Vec<Cow<DMatrix<f64>>> = set.training.iter().map(|one| learned.targets(one)).collect();
            let mut fitted = Standardizer::fit(&all.iter().map(AsRef::as_ref).collect::<Vec<_>>());
            if scale == Scale::Together {
                let squares: f64 = fitted.spread.iter().map(|spread| spread * spread).sum();
                let together = (squares / fitted.spread.len() as f64).sqrt();
                fitted.spread.fill(together);
            }
            learned.scalers.targets = fitted;
        }
        learned
    }

    /// Returns r of a sequence, in the targets' own unit.
    pub fn targets<'s>(&self, sequence: &'s Sequence) -> Cow<'s, DMatrix<f64>> {
        match self.last_values(sequence) {
            None => Cow::Borrowed(&sequence.targets),
            Some(seen) => Cow::Owned(&sequence.targets - seen),
        }
    }

    /// Returns the predictions of the targets [N×O] from a network's output, standardised, of all of `sequences`.
    pub fn restore(&self, said: &DMatrix<f64>, sequences: &[Sequence]) -> DMatrix<f64> {
        let mut predicted = self.scalers.targets.restore(said);
        let mut row = 0;
        for seen in sequences.iter().filter_map(|one| self.last_values(one)) {
            let mut own = predicted.rows_mut(row, seen.nrows());
            own += &seen;
            row += seen.nrows();
        }
        predicted
    }

    /// Returns u at the supervised steps.
    fn last_values(&self, sequence: &Sequence) -> Option<DMatrix<f64>> {
        let rows = sequence.targets.nrows();
        let places = self.places.as_ref()?;
        Some(sequence.inputs.rows(sequence.steps() - rows, rows).select_columns(places))
    }
}

#[cfg(test)]
mod tests {
    use acm_datasets::sequences::Asked;

    use super::*;

    fn set() -> SequenceSet {
        let one = |name: &str, inputs: &[f64], targets: &[f64]| Sequence {
            name: name.into(),
            elapsed: vec![1.0; 2],
            inputs: DMatrix::from_row_slice(2, 3, inputs),
            targets: DMatrix::from_row_slice(2, 2, targets),
        };
        let a = one("a", &[1.0, 10.0, 0.0, 2.0, 20.0, 0.0], &[13.0, 2.0, 17.0, 3.0]);
        let b = one("b", &[0.0, 0.0, 5.0, 0.0, 0.0, 5.0], &[3.0, 1.0, -3.0, 1.0]);
        let names = |names: &[&str]| names.iter().map(ToString::to_string).collect();
        SequenceSet {
            channels: names(&["y", "x", "c"]),
            outputs: names(&["x", "y"]),
            asked: Asked::Every,
            training: vec![a.clone()],
            validation: vec![b],
            test: vec![a],
        }
    }

    /// Oracle: by hand. x: 13 − 10, 17 − 20; y: 2 − 1, 3 − 2; so mean 0 and 1, spread 3 and 0 (which becomes 1).
    #[test]
    fn what_the_last_value_misses_is_learned_and_added_again() {
        let set = set();
        let learned = Learned::new(&set, Loss::MeanSquare, Persistence::Persistence, Scale::Each);
        assert_eq!(learned.targets(&set.training[0]).as_slice(), &[3.0, -3.0, 1.0, 1.0]);
        assert_eq!(
            (&learned.scalers.targets.mean[..], &learned.scalers.targets.spread[..]),
            (&[0.0, 1.0][..], &[3.0, 1.0][..])
        );
        let said = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let both = [set.training[0].clone(), set.validation[0].clone()];
        let predicted = learned.restore(&said, &both);
        assert_eq!(predicted, DMatrix::from_row_slice(4, 2, &[13.0, 2.0, 17.0, 3.0, 0.0, 1.0, 0.0, 1.0]));
    }

    /// Oracle: by hand. Spreads 2 and 0.5 of the targets have the root mean square √(4.25/2).
    #[test]
    fn one_spread_for_all_keeps_errors_in_proportion() {
        let set = set();
        let learned = Learned::new(&set, Loss::MeanSquare, Persistence::None, Scale::Together);
        let spread = (4.25_f64 / 2.0).sqrt();
        assert_eq!(learned.scalers.targets.spread, [spread, spread]);
        assert_eq!(learned.scalers.targets.mean, [15.0, 2.5]);
        let zero = learned.restore(&DMatrix::zeros(2, 2), &set.training);
        assert_eq!(zero, DMatrix::from_row_slice(2, 2, &[15.0, 2.5, 15.0, 2.5]));
    }
}
