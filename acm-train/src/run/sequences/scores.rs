//! Scores of predictions.
//!
//! ```text
//! labels    accuracy = share of targets on whose side of 0 the logit is      loss = mean cross-entropy
//! numbers   RMSE_o = √( Σ (p_o − t_o)² / N )  in the target's unit           loss = Σ_o RMSE_o² / O
//! ```

use acm_datasets::sequences::{Sequence, SequenceSet};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::config::Loss;

/// Scores of one part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Number of sequences.
    pub sequences: usize,
    /// Number of supervised steps.
    pub targets: usize,
    /// Mean loss, in the targets' own unit.
    pub loss: f64,
    /// Share of correct labels.
    pub accuracy: Option<f64>,
    /// Root mean square error of each output, in its unit.
    pub rmse: Option<Vec<f64>>,
}

/// Returns the scores of predictions [N×O] against targets [N×O] of a number of sequences.
pub fn scores(sequences: usize, predicted: &DMatrix<f64>, targets: &DMatrix<f64>, loss: Loss) -> Scores {
    let n = targets.nrows();
    let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
    match loss {
        Loss::CrossEntropy => {
            let right =
                predicted.iter().zip(targets).filter(|(logit, label)| (**logit > 0.0) == (**label > 0.5)).count();
            let entropy = |(z, t): (&f64, &f64)| z.max(0.0) - z * t + (-z.abs()).exp().ln_1p();
            let sum = predicted.iter().zip(targets).map(entropy).sum();
            let accuracy = Some(mean(right as f64, targets.len()));
            Scores { sequences, targets: n, loss: mean(sum, targets.len()), accuracy, rmse: None }
        }
        Loss::MeanSquare => {
            let rmse: Vec<f64> =
                (predicted - targets).column_iter().map(|error| mean(error.norm_squared(), n).sqrt()).collect();
            let loss = mean(rmse.iter().map(|rmse| rmse * rmse).sum(), rmse.len());
            Scores { sequences, targets: n, loss, accuracy: None, rmse: Some(rmse) }
        }
    }
}

/// Returns the targets of all sequences, row after row [N×O].
pub fn targets(sequences: &[Sequence]) -> DMatrix<f64> {
    stack(sequences, |sequence| sequence.targets.clone())
}

/// Returns the RMSE by output if the last value is repeated; `None` where a target is no input.
pub fn persistence(set: &SequenceSet) -> Option<Vec<f64>> {
    let places: Option<Vec<usize>> =
        set.outputs.iter().map(|output| set.channels.iter().position(|channel| channel == output)).collect();
    scores(set.test.len(), &last_values(&set.test, &places?), &targets(&set.test), Loss::MeanSquare).rmse
}

/// Returns the last values of the inputs at `places` before each target [N×O].
pub fn last_values(sequences: &[Sequence], places: &[usize]) -> DMatrix<f64> {
    stack(sequences, |sequence| {
        let rows = sequence.targets.nrows();
        sequence.inputs.rows(sequence.steps() - rows, rows).select_columns(places)
    })
}

fn stack(sequences: &[Sequence], of: impl Fn(&Sequence) -> DMatrix<f64>) -> DMatrix<f64> {
    let parts: Vec<DMatrix<f64>> = sequences.iter().map(of).collect();
    let columns = parts.first().map_or(0, DMatrix::ncols);
    let rows = parts.iter().flat_map(|part| part.row_iter());
    let numbers = rows.flat_map(|row| row.iter().copied().collect::<Vec<_>>());
    DMatrix::from_row_iterator(parts.iter().map(DMatrix::nrows).sum(), columns, numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. A logit of 0 says 0; ln 2 is the entropy of a coin.
    #[test]
    fn labels() {
        let column = |values: &[f64]| DMatrix::from_column_slice(values.len(), 1, values);
        let found = scores(4, &column(&[3.0, -3.0, 0.0, 2.0]), &column(&[1.0, 0.0, 0.0, 0.0]), Loss::CrossEntropy);
        let entropy = (2.0 * (1.0 + f64::exp(-3.0)).ln() + 2f64.ln() + (1.0 + f64::exp(2.0)).ln()) / 4.0;
        assert_eq!((found.accuracy, found.targets), (Some(0.75), 4));
        assert!((found.loss - entropy).abs() < 1e-15);
    }

    /// Oracle: by hand. Errors 0, 2 and 1, 1.
    #[test]
    fn numbers() {
        let matrix = |values: &[f64]| DMatrix::from_row_slice(2, 2, values);
        let found = scores(1, &matrix(&[1.0, 2.0, 3.0, 4.0]), &matrix(&[1.0, 1.0, 5.0, 3.0]), Loss::MeanSquare);
        assert_eq!(found.rmse, Some(vec![2f64.sqrt(), 1.0]));
        assert!((found.loss - 1.5).abs() < 1e-15);
    }
}
