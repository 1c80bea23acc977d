//! What can be said without a network: the last value of each target, or the mean of the training part.
//!
//! ```text
//! last value   p_o = u_o                           where each target is a later value of an input u_o
//! mean         p_o = Σ t_o / N                     over the training part
//! labels       p_o = ln( r / (1 − r) )             r = (Σ t_o + 1) / (N + 2), the share of ones
//! ```

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;

use crate::config::{Loss, Question, QuestionData};
use crate::run::sequences::scores::{last_values, targets};

/// A prediction without a network.
#[derive(Debug, Clone, PartialEq)]
pub enum Constant {
    /// The last value of each target, at these places among the inputs.
    LastValue(Vec<usize>),
    /// A number for each target.
    Number(Vec<f64>),
}

impl Constant {
    /// Returns the prediction that suits a question.
    pub fn of(question: &Question, set: &SequenceSet) -> Self {
        let ahead = matches!(&question.data, QuestionData::Table(asked) if asked.ahead > 0);
        let place = |output: &String| set.channels.iter().position(|channel| channel == output);
        let places: Option<Vec<usize>> = set.outputs.iter().map(place).collect();
        if let (true, Loss::MeanSquare, Some(places)) = (ahead, question.loss, places) {
            return Self::LastValue(places);
        }
        let all = targets(&set.training);
        let count = all.nrows() as f64;
        Self::Number(match question.loss {
            Loss::MeanSquare => all.column_iter().map(|column| column.sum() / count).collect(),
            Loss::CrossEntropy => {
                all.column_iter().map(|column| ((column.sum() + 1.0) / (count - column.sum() + 1.0)).ln()).collect()
            }
        })
    }

    /// Returns its name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::LastValue(_) => "the last value",
            Self::Number(_) => "the mean",
        }
    }

    /// Returns the number of its fitted values.
    pub fn numbers(&self) -> usize {
        match self {
            Self::LastValue(_) => 0,
            Self::Number(values) => values.len(),
        }
    }

    /// Returns what a regression adds its answer to [N×O]: the last values, or zeros.
    pub fn last(&self, sequences: &[Sequence]) -> DMatrix<f64> {
        match self {
            Self::LastValue(_) => self.predict(sequences),
            Self::Number(values) => DMatrix::zeros(sequences.iter().map(|one| one.targets.nrows()).sum(), values.len()),
        }
    }

    /// Returns its predictions for sequences [N×O].
    pub fn predict(&self, sequences: &[Sequence]) -> DMatrix<f64> {
        match self {
            Self::LastValue(places) => last_values(sequences, places),
            Self::Number(values) => {
                let rows = sequences.iter().map(|one| one.targets.nrows()).sum();
                DMatrix::from_fn(rows, values.len(), |_, o| values[o])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use acm_datasets::sequences::Asked;

    use super::*;

    fn set() -> SequenceSet {
        let one = |targets: &[f64]| Sequence {
            name: "a".into(),
            elapsed: vec![1.0; 2],
            inputs: DMatrix::from_row_slice(2, 2, &[7.0, 1.0, 8.0, 2.0]),
            targets: DMatrix::from_row_slice(2, 1, targets),
        };
        SequenceSet {
            channels: vec!["v".into(), "x".into()],
            outputs: vec!["x".into()],
            asked: Asked::Every,
            training: vec![one(&[1.0, 0.0]), one(&[1.0, 1.0])],
            validation: vec![one(&[0.0, 0.0])],
            test: vec![],
        }
    }

    /// Oracle: by hand. Three of four are one: with one more of each, 4 to 2.
    #[test]
    fn by_hand() {
        let (set, mut question) = (set(), Question::default());
        let said = |question: &Question| Constant::of(question, &set).predict(&set.validation);
        assert_eq!(said(&question).as_slice(), &[0.75, 0.75]);
        question.loss = Loss::CrossEntropy;
        assert_eq!(said(&question).as_slice(), &[2.0_f64.ln(); 2]);
        assert_eq!(Constant::LastValue(vec![1]).predict(&set.validation).as_slice(), &[1.0, 2.0]);
    }
}
