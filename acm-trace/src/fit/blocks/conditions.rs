//! Conditions: trials at the same level of a context signal, such as a load that was hung on or an altitude.
//!
//! With a trial of each condition among those that are fitted, a model that says nothing about the condition errs no more on
//! trials left out than one that does. So conditions are left out whole. Roberts et al. (2017), Ecography 40(8).
//!
//! The means of a signal over trials, sorted, have levels where every step between two levels is at least [`APART`] times the
//! widest level.

/// Smallest number of levels, of which one is left out, that a dependence on them is fitted to: two others.
const LEVELS: usize = 3;

/// Smallest number of trials of a level; levels of one trial each are the trials.
const TRIALS: usize = 2;

/// Smallest ratio of the step between two levels to the widest level. Means that are drawn from one range at random have
/// levels in 0.4 % of draws of six trials, and in 0.03 % of nine.
const APART: f64 = 5.0;

/// Returns the condition of each trial, as a number from 0 on, by the signal with the most levels; none where no signal has
/// levels. `means` are of each signal over each trial.
pub fn conditions(means: &[Vec<f64>]) -> Option<Vec<usize>> {
    let levels = means.iter().filter_map(|of_trials| levels(of_trials));
    levels.reduce(|most, next| if next.iter().max() > most.iter().max() { next } else { most })
}

/// Returns the level of each mean; none where they have no levels.
fn levels(means: &[f64]) -> Option<Vec<usize>> {
    let mut order: Vec<usize> = (0..means.len()).collect();
    order.sort_by(|&a, &b| means[a].total_cmp(&means[b]));
    let mut steps: Vec<f64> = order.windows(2).map(|pair| means[pair[1]] - means[pair[0]]).collect();
    steps.sort_by(|a, b| b.total_cmp(a));
    (LEVELS..=means.len() / TRIALS).rev().find_map(|count| {
        let step = steps[count - 2];
        let at: Vec<&[usize]> = order.chunk_by(|&a, &b| means[b] - means[a] < step).collect();
        let is_narrow = |trials: &&[usize]| APART * (means[trials[trials.len() - 1]] - means[trials[0]]) <= step;
        let are_levels = step > 0.0 && at.iter().all(|trials| trials.len() >= TRIALS && is_narrow(trials));
        are_levels
            .then(|| (0..means.len()).map(|s| at.iter().take_while(|trials| !trials.contains(&s)).count()).collect())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_loads_are_three_conditions_and_a_signal_that_wanders_has_none() {
        let loads = vec![11.3, 23.3, 46.6, 11.8, 23.7, 46.8, 12.0, 23.7, 47.2];
        let wanders = vec![20.0, 21.0, 22.4, 23.1, 24.9, 25.0, 26.2, 27.7, 28.1];
        assert_eq!(conditions(&[wanders.clone(), loads]), Some(vec![0, 1, 2, 0, 1, 2, 0, 1, 2]));
        assert_eq!(conditions(&[wanders]), None);
        assert_eq!(conditions(&[]), None);
    }

    #[test]
    fn the_signal_with_the_most_levels_is_taken_and_levels_of_one_trial_are_none() {
        let three = vec![1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0];
        let four = vec![4.0, 3.0, 2.0, 1.0, 4.0, 3.0, 2.0, 1.0];
        assert_eq!(conditions(&[three, four]), Some(vec![3, 2, 1, 0, 3, 2, 1, 0]));
        assert_eq!(conditions(&[vec![1.0, 1.0, 2.0, 2.0]]), None, "two levels");
        assert_eq!(conditions(&[vec![1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0]]), None, "one trial alone");
        assert_eq!(conditions(&[vec![1.0; 9]]), None);
    }

    #[test]
    fn means_that_are_drawn_at_random_pass_as_levels_as_often_as_is_said() {
        use rand::{RngExt, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut share = |trials: usize| {
            let drawn = (0..20_000).filter(|_| {
                let means: Vec<f64> = (0..trials).map(|_| random.random()).collect();
                levels(&means).is_some()
            });
            drawn.count() as f64 / 20_000.0
        };
        assert!((share(6) - 0.0037).abs() < 0.0015 && share(9) < 0.001);
    }
}
