//! Gradient-boosted trees on a few lags, one booster per output (library forust).
//!
//! ```text
//! φ_k = (x_{k−l}, Δt_{k−l+1} + … + Δt_k  for l in lags)        ŷ_k = ȳ + Σ_{r ≤ R} η T_r(φ_k)   of each output
//! ```
//!
//! | symbol | meaning                                                   | shape | unit |
//! | ------ | --------------------------------------------------------- | ----- | ---- |
//! | l      | lag: how many samples back                                |       | 1    |
//! | x      | channels, standardised                                    | [C]   | –    |
//! | Δt     | elapsed time; the sum is left out for lag 0               |       | s    |
//! | T_r    | tree of round r, fitted to what the rounds before leave   |       | –    |
//! | η      | learning rate                                             |       | 1    |
//! | R      | rounds that are kept, for each output                     |       | 1    |
//!
//! An output grows until its validation loss has not fallen for `patience` rounds, and keeps the rounds up to the
//! smallest. Row r of the record is the loss over all outputs with min(r, R) rounds, so the best row is the largest R.
//! Each booster works on one thread, several of them side by side, so threads change no sum.
//! Friedman (2001), Annals of Statistics 29(5).

use std::fmt;

use forust_ml::{GradientBooster, Matrix, metric::Metric, objective::ObjectiveType};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::{
    fitted::{Fitted, best},
    lagged::Lagged,
};
use crate::config::TreesConfig;
use crate::learn::error::LearnError;
use crate::learn::fit::epoch::Epoch;
use crate::learn::fit::task::{Control, Ended};

/// One booster per output.
pub struct Boosters {
    lags: Vec<usize>,
    of_output: Vec<GradientBooster>,
}

/// Fits the trees of each output and keeps its best number of rounds. The fit takes seconds and cannot be interrupted.
pub fn fit(
    config: &TreesConfig,
    training: &Lagged,
    validation: &Lagged,
    observer: &mut dyn FnMut(&Epoch) -> Control,
) -> Result<Fitted<Boosters>, LearnError> {
    let lags = config.lags.clone().unwrap_or_else(|| powers_of_two(training.length()));
    let (seen, unseen) = (Table::new(training, &lags), Table::new(validation, &lags));
    let grown = (0..training.outputs()).into_par_iter().map(|output| grow(config, &seen, &unseen, output));
    let of_output = grown.collect::<Result<Vec<_>, _>>()?;
    let epochs: Vec<Epoch> = (0..of_output.iter().map(|booster| booster.trees.len()).max().unwrap_or(0))
        .map(|round| epoch(&of_output, round))
        .collect();
    for epoch in &epochs {
        observer(epoch);
    }
    let model = Boosters { lags, of_output };
    Ok(Fitted { model, best_epoch: best(&epochs), epochs, ended: Ended::Epochs })
}

impl Boosters {
    /// Returns the number of leaves of the rounds that are kept.
    pub fn leaves(&self) -> usize {
        let trees = self.of_output.iter().flat_map(|booster| &booster.trees[..kept(booster)]);
        trees.flat_map(|tree| &tree.nodes).filter(|node| node.is_leaf).count()
    }

    /// Returns the predictions [N×O].
    pub fn predict(&self, windows: &Lagged) -> DMatrix<f64> {
        let table = Table::new(windows, &self.lags);
        let estimates: Vec<f64> =
            self.of_output.par_iter().flat_map(|booster| booster.predict(&table.matrix(), false)).collect();
        DMatrix::from_vec(windows.len(), self.of_output.len(), estimates)
    }
}

impl fmt::Debug for Boosters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Boosters").field("lags", &self.lags).finish_non_exhaustive()
    }
}

/// Returns the number of rounds R that are kept.
fn kept(booster: &GradientBooster) -> usize {
    booster.prediction_iteration.unwrap_or(booster.trees.len())
}

/// Returns 0, 1, 2, 4, … up to the length of a window.
fn powers_of_two(length: usize) -> Vec<usize> {
    let powers = std::iter::successors(Some(1usize), |lag| lag.checked_mul(2));
    std::iter::once(0).chain(powers.take_while(|&lag| lag < length)).collect()
}

/// Features and targets of a part, column by column.
struct Table {
    rows: usize,
    features: Vec<f64>,
    targets: DMatrix<f64>,
    weights: Vec<f64>,
}

impl Table {
    fn new(windows: &Lagged, lags: &[usize]) -> Self {
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
        Self { rows, features, targets: windows.targets(), weights: vec![1.0; rows] }
    }

    fn matrix(&self) -> Matrix<'_, f64> {
        Matrix::new(&self.features, self.rows, self.features.len() / self.rows.max(1))
    }

    fn target(&self, output: usize) -> &[f64] {
        &self.targets.as_slice()[output * self.rows..(output + 1) * self.rows]
    }
}

fn grow(config: &TreesConfig, seen: &Table, unseen: &Table, output: usize) -> Result<GradientBooster, LearnError> {
    let mut booster = GradientBooster::default()
        .set_objective_type(ObjectiveType::SquaredLoss)
        // The library's own choice for squared loss is the error of logarithms.
        .set_evaluation_metric(Some(Metric::RootMeanSquaredError))
        .set_initialize_base_score(true)
        .set_iterations(config.rounds)
        .set_early_stopping_rounds(Some(config.patience))
        .set_learning_rate(config.learning_rate as f32)
        .set_max_depth(config.depth)
        .set_min_leaf_weight(config.leaf_windows as f32)
        .set_l2(config.penalty as f32)
        .set_parallel(false);
    let part = |table| (Table::matrix(table), Table::target(table, output), table.weights.as_slice());
    let (matrix, target, weights) = part(seen);
    let refuse = |error| {
        LearnError::Baseline(format!("trees cannot be grown for output {output}: {error}; check inputs and outputs"))
    };
    booster.fit(&matrix, target, weights, Some(vec![part(seen), part(unseen)])).map_err(refuse)?;
    Ok(booster)
}

/// Returns the losses after a round, as means over the outputs.
fn epoch(boosters: &[GradientBooster], round: usize) -> Epoch {
    let loss = |part: usize| {
        let squared = |booster: &GradientBooster| {
            let round = round.min(kept(booster).max(1) - 1);
            booster.evaluation_history.as_ref().map_or(f64::NAN, |history| history.get(round, part).powi(2))
        };
        boosters.iter().map(squared).sum::<f64>() / boosters.len() as f64
    };
    let learning_rate = boosters.first().map_or(0.0, |booster| f64::from(booster.learning_rate));
    Epoch { epoch: round + 1, learning_rate, train_loss: loss(0), validation_loss: loss(1) }
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
