//! The learning rate of each epoch, as a function of the epochs before it.
//!
//! ```text
//! η_e = η_0 · w_e · s_e,   w_e = min(1, e / (warm_up + 1)),   e = 1, 2, …
//! ```
//!
//! | kind     | `s_e`                                                                  |
//! | -------- | ---------------------------------------------------------------------- |
//! | constant | 1                                                                      |
//! | cosine   | f + (1 − f)(1 + cos(π (e − 1)/E))/2, with E epochs and floor f         |
//! | step     | factor^⌊(e − 1)/every⌋                                                 |
//! | plateau  | factor^k, where k counts the times that `patience` epochs in a row did |
//! |          | not lower the best validation loss by a ten thousandth of it           |
//!
//! Being a function of the history, the schedule has no state of its own to keep in a checkpoint. Cosine:
//! Loshchilov and Hutter (2017), SGDR, without restarts. Plateau: torch's `ReduceLROnPlateau`.

use std::f64::consts::PI;

use crate::config::{Schedule, TrainingConfig};
use crate::learn::fit::epoch::Epoch;

/// A fall of the loss by less than this share is none.
const FALL: f64 = 1e-4;

/// Returns the learning rate of the epoch that follows `before`.
pub fn rate(config: &TrainingConfig, before: &[Epoch]) -> f64 {
    let done = before.len();
    let warm = ((done + 1) as f64 / (config.warm_up + 1) as f64).min(1.0);
    let share = match config.schedule {
        Schedule::Constant => 1.0,
        Schedule::Cosine { floor } => {
            let angle = PI * done as f64 / config.epochs as f64;
            floor + (1.0 - floor) * (1.0 + angle.cos()) / 2.0
        }
        Schedule::Step { every, factor } => factor.powi((done / every) as i32),
        Schedule::Plateau { patience, factor } => factor.powi(plateaus(before, patience)),
    };
    config.learning_rate * warm * share
}

/// Returns the number of times that the loss has not fallen for `patience` epochs.
fn plateaus(before: &[Epoch], patience: usize) -> i32 {
    let (mut best, mut waited, mut count) = (f64::INFINITY, 0, 0);
    for epoch in before {
        if epoch.validation_loss < best * (1.0 - FALL) {
            (best, waited) = (epoch.validation_loss, 0);
        } else {
            waited += 1;
        }
        if waited > patience {
            (waited, count) = (0, count + 1);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(losses: &[f64]) -> Vec<Epoch> {
        let epoch = |(i, &validation_loss): (usize, &f64)| Epoch {
            epoch: i + 1,
            learning_rate: 0.0,
            train_loss: 0.0,
            validation_loss,
        };
        losses.iter().enumerate().map(epoch).collect()
    }

    fn rates(schedule: Schedule, warm_up: usize, losses: &[f64]) -> Vec<f64> {
        let config = TrainingConfig { schedule, warm_up, learning_rate: 1.0, epochs: 4, ..TrainingConfig::default() };
        let before = after(losses);
        (0..=losses.len()).map(|done| rate(&config, &before[..done])).collect()
    }

    /// Oracle: the table above, by hand.
    #[test]
    fn rates_are_those_of_the_table() {
        let four = [1.0; 4];
        assert_eq!(rates(Schedule::Constant, 0, &four), [1.0; 5]);
        assert_eq!(rates(Schedule::Constant, 3, &four), [0.25, 0.5, 0.75, 1.0, 1.0]);
        assert_eq!(rates(Schedule::Step { every: 2, factor: 0.1 }, 0, &four)[..4], [1.0, 1.0, 0.1, 0.1]);
        let cosine = rates(Schedule::Cosine { floor: 0.2 }, 0, &four);
        for (found, expected) in
            cosine.iter().zip([1.0, 0.6 + 0.4 * 0.5f64.sqrt(), 0.6, 0.6 - 0.4 * 0.5f64.sqrt(), 0.2])
        {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }

    /// Oracle: by hand. Patience 1: the second epoch in a row without a fall halves the rate.
    #[test]
    fn a_plateau_lowers_the_rate_once_and_waits_again() {
        let plateau = Schedule::Plateau { patience: 1, factor: 0.5 };
        let losses = [3.0, 2.0, 2.0, 1.99999, 1.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(rates(plateau, 0, &losses), [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.25, 0.25, 0.125]);
    }
}
