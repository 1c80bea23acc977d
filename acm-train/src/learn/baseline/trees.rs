//! Gradient-boosted trees on a few lags of the last step of a window.
//!
//! ```text
//! φ_k = (x_{k−l}, Δt_{k−l+1} + … + Δt_k  for l in lags)        ŷ_k = forest(φ_k)        [`forest`](super::forest)
//! ```
//!
//! | symbol | meaning                                                   | shape | unit |
//! | ------ | --------------------------------------------------------- | ----- | ---- |
//! | l      | lag: how many samples back                                |       | 1    |
//! | x      | channels, standardised                                    | [C]   | –    |
//! | Δt     | elapsed time; the sum is left out for lag 0               |       | s    |
//!
//! Row r of the record is the loss over all outputs with min(r, R) rounds, so the best row is the largest R.

use nalgebra::DMatrix;

use super::{
    fitted::{Fitted, best},
    forest::{Forest, Table},
    lagged::Lagged,
};
use crate::config::{Loss, TreesConfig};
use crate::learn::error::LearnError;
use crate::learn::fit::epoch::Epoch;
use crate::learn::fit::task::{Control, Ended};

/// Trees on lagged inputs.
#[derive(Debug)]
pub struct Boosters {
    lags: Vec<usize>,
    forest: Forest,
}

/// Fits the trees of each output and keeps its best number of rounds. The fit takes seconds and cannot be interrupted.
pub fn fit(
    config: &TreesConfig,
    training: &Lagged,
    validation: &Lagged,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted<Boosters>, LearnError> {
    let lags = config.lags.clone().unwrap_or_else(|| powers_of_two(training.length()));
    let part = |windows: &Lagged| Table::new(features(windows, &lags), windows.targets());
    let forest = Forest::grow(config, Loss::MeanSquare, &part(training), &part(validation))?;
    let epochs = forest.epochs();
    for epoch in &epochs {
        observer(epoch);
    }
    let model = Boosters { lags, forest };
    Ok(Fitted { model, best_epoch: best(&epochs), epochs, ended: Ended::Epochs })
}

impl Boosters {
    /// Returns the number of leaves of the rounds that are kept.
    pub fn leaves(&self) -> usize {
        self.forest.leaves()
    }

    /// Returns the predictions [N×O].
    pub fn predict(&self, windows: &Lagged) -> DMatrix<f64> {
        self.forest.predict(&features(windows, &self.lags))
    }
}

/// Returns 0, 1, 2, 4, … up to the length of a window.
fn powers_of_two(length: usize) -> Vec<usize> {
    let powers = std::iter::successors(Some(1usize), |lag| lag.checked_mul(2));
    std::iter::once(0).chain(powers.take_while(|&lag| lag < length)).collect()
}

/// Returns the features of all windows, a window a row.
fn features(windows: &Lagged, lags: &[usize]) -> DMatrix<f64> {
    let rows = windows.len();
    let mut features = vec![];
    for &lag in lags {
        for channel in 0..windows.channels() {
            features.extend((0..rows).map(|row| windows.input(row, lag, channel)));
        }
        if lag > 0 {
            features.extend((0..rows).map(|row| windows.age(row, lag)));
        }
    }
    DMatrix::from_vec(rows, features.len() / rows.max(1), features)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::baseline::{
        fitted::mean_square,
        lagged::tests::{identity, one_series, windows},
    };
    use acm_datasets::Series;

    /// Returns a series of steps. Input 0 is a sawtooth of incommensurable period, input 1 is another, input 2 is
    /// constant. Output 0 is the sign of input 0 two samples ago, output 1 a product of signs; both of size 1.
    fn steps(samples: usize, phase: f64) -> [Series; 1] {
        let wave = |k: usize, c: usize| ((k as f64 + phase) * [0.381966, 0.135789][c]).rem_euclid(1.0) - 0.5;
        let inputs = DMatrix::from_fn(samples, 3, |k, c| if c == 2 { 7.0 } else { wave(k, c) });
        let planted = |k: usize, o: usize| {
            let first = wave(k.saturating_sub(2), 0).signum();
            if o == 0 { first } else { first * wave(k, 1).signum() }
        };
        [one_series(inputs, DMatrix::from_fn(samples, 2, planted))]
    }

    fn fitted(config: &TreesConfig, threads: usize) -> (Fitted<Boosters>, DMatrix<f64>, DMatrix<f64>) {
        let (seen, unseen, scalers) = (steps(600, 0.0), steps(300, 0.21), identity(3, 2));
        let (a, b) = (windows(&seen, 4), windows(&unseen, 4));
        let [seen, unseen] = [(&seen, &a), (&unseen, &b)].map(|(s, w)| Lagged::new(s, w, 4, &scalers));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let fitted = fit(config, &seen, &unseen, &mut |_| Control::Continue).unwrap();
            let predicted = fitted.model.predict(&unseen);
            (fitted, predicted, unseen.targets())
        })
    }

    /// Oracle: a planted step of one input, and one of two inputs together, which no line can follow.
    #[test]
    fn planted_steps_are_recovered() {
        let config = TreesConfig { rounds: 60, learning_rate: 0.3, ..TreesConfig::default() };
        let (fitted, predicted, truth) = fitted(&config, 1);
        assert!((1..=60).contains(&fitted.epochs.len()));
        // Beside a step a tree may cut between other samples, and be off by as much as the step: 2.
        let wrong = predicted.iter().zip(&truth).filter(|(p, t)| (*p - *t).abs() > 0.1).count();
        assert!(wrong * 20 < truth.len(), "{wrong} of {} are off by more than 0.1", truth.len());
        let kept = fitted.epochs[fitted.best_epoch - 1];
        assert!(fitted.epochs.iter().all(|epoch| epoch.validation_loss >= kept.validation_loss));
        let loss = mean_square(&predicted, &truth);
        assert!((loss - kept.validation_loss).abs() < 1e-12, "{loss} for {}", kept.validation_loss);
    }

    #[test]
    fn threads_change_no_bit() {
        let config = TreesConfig { rounds: 20, ..TreesConfig::default() };
        let (one, three) = (fitted(&config, 1), fitted(&config, 3));
        assert_eq!(one.0.epochs, three.0.epochs);
        assert_eq!(one.1, three.1);
    }

    /// Oracle: a tree of depth 1 has two leaves; three rounds of a small rate lower every loss, so all are kept.
    #[test]
    fn leaves_are_counted_up_to_the_kept_round() {
        let config = TreesConfig { rounds: 3, depth: 1, ..TreesConfig::default() };
        let (fitted, ..) = fitted(&config, 1);
        let leaves = fitted.model.leaves();
        assert!(fitted.best_epoch == 3 && (8..=12).contains(&leaves) && leaves % 2 == 0, "{leaves}");
    }

    #[test]
    fn lags_double_within_the_window() {
        assert_eq!(powers_of_two(50), [0, 1, 2, 4, 8, 16, 32]);
        assert_eq!(powers_of_two(5), [0, 1, 2, 4]);
        assert_eq!(powers_of_two(1), [0]);
    }
}
