//! Features of a regression: inputs of the last steps, and the elapsed time at each.
//!
//! ```text
//! φ_k = (x_{k−l}, Δt_{k−l}  for l in lags)        standardised by the training part; 0 before a sequence begins
//! ```

use acm_datasets::sequences::Sequence;
use nalgebra::DMatrix;

/// Mean and spread of each input and, behind them, of the elapsed time.
#[derive(Debug, Clone)]
pub struct Inputs {
    mean: Vec<f64>,
    spread: Vec<f64>,
}

impl Inputs {
    /// Returns those of all steps of some sequences.
    pub fn of(sequences: &[Sequence]) -> Self {
        let count = sequences.iter().map(Sequence::steps).sum::<usize>() as f64;
        let columns = sequences.first().map_or(0, |first| first.inputs.ncols());
        let mean_of = |value: &dyn Fn(&Sequence, usize) -> f64| {
            sequences.iter().map(|one| (0..one.steps()).map(|step| value(one, step)).sum::<f64>()).sum::<f64>() / count
        };
        let of = |column: usize| {
            let value = |one: &Sequence, step: usize| raw(one, step, column);
            let mean = mean_of(&value);
            let spread = mean_of(&|one, step| (value(one, step) - mean).powi(2)).sqrt();
            (mean, if spread > 0.0 { spread } else { 1.0 })
        };
        let (mean, spread) = (0..=columns).map(of).unzip();
        Self { mean, spread }
    }

    /// Returns the number of columns of each lag, C + 1.
    pub fn width(&self) -> usize {
        self.mean.len()
    }

    /// Returns the features of each step with targets [T×n(C+1)], lag after lag.
    pub fn lagged(&self, sequence: &Sequence, lags: &[usize]) -> DMatrix<f64> {
        let first = first(sequence);
        DMatrix::from_fn(sequence.targets.nrows(), lags.len() * self.width(), |row, place| {
            let (lag, column) = (lags[place / self.width()], place % self.width());
            (first + row).checked_sub(lag).map_or(0.0, |step| self.standardised(sequence, step, column))
        })
    }

    /// Returns the means over all steps up to each step with targets [T×(C+1)].
    pub fn means(&self, sequence: &Sequence) -> DMatrix<f64> {
        let first = first(sequence);
        let mut means = DMatrix::zeros(sequence.targets.nrows(), self.width());
        for column in 0..self.width() {
            let mut sum = 0.0;
            for step in 0..first + means.nrows() {
                sum += self.standardised(sequence, step, column);
                if let Some(row) = step.checked_sub(first) {
                    means[(row, column)] = sum / (step + 1) as f64;
                }
            }
        }
        means
    }

    fn standardised(&self, sequence: &Sequence, step: usize, column: usize) -> f64 {
        (raw(sequence, step, column) - self.mean[column]) / self.spread[column]
    }
}

/// Returns the first step with targets.
fn first(sequence: &Sequence) -> usize {
    sequence.steps() - sequence.targets.nrows()
}

/// Returns an input at a step; behind the inputs, the elapsed time.
fn raw(sequence: &Sequence, step: usize, column: usize) -> f64 {
    if column < sequence.inputs.ncols() { sequence.inputs[(step, column)] } else { sequence.elapsed[step] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. The input 1, 3, 5, 7 has mean 4 and spread √5; the elapsed time is constant. The last two steps have targets.
    #[test]
    fn by_hand() {
        let one = Sequence {
            name: "a".into(),
            elapsed: vec![2.0; 4],
            inputs: DMatrix::from_column_slice(4, 1, &[1.0, 3.0, 5.0, 7.0]),
            targets: DMatrix::zeros(2, 1),
        };
        let inputs = Inputs::of(std::slice::from_ref(&one));
        let said = inputs.lagged(&one, &[0, 3]) * 5.0_f64.sqrt();
        let wanted = DMatrix::from_row_slice(2, 4, &[1.0, 0.0, 0.0, 0.0, 3.0, 0.0, -3.0, 0.0]);
        assert!((said - wanted).amax() < 1e-14);
        let means = inputs.means(&one) * 5.0_f64.sqrt();
        assert!((means - DMatrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, 0.0])).amax() < 1e-14);
    }
}
