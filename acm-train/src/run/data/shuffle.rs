//! Shuffled inputs: values are permuted over times and trials of the same part.
//!
//! The distribution of the values stays as it was, and so does the network's size: what is lost is when each value was
//! recorded, alone.

use acm_datasets::Series;
use rand::{SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// Permutes one input column over all samples of a part. The permutation depends on the input's name, the names of the
/// trials and their lengths, and on no seed: all runs see the same inputs.
pub fn shuffle(part: &mut [Series], column: usize, name: &str) {
    let mut hash = Sha256::new();
    hash.update(name);
    for series in part.iter() {
        hash.update(&series.trial);
        hash.update((series.time.len() as u64).to_le_bytes());
    }
    let mut values = all(part, column);
    values.shuffle(&mut ChaCha8Rng::from_seed(hash.finalize().into()));
    let mut values = values.into_iter();
    for series in part {
        for (value, shuffled) in series.inputs.column_mut(column).iter_mut().zip(&mut values) {
            *value = shuffled;
        }
    }
}

fn all(part: &[Series], column: usize) -> Vec<f64> {
    let mut values = vec![];
    part.iter().for_each(|series| values.extend(series.inputs.column(column).iter()));
    values
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    fn part() -> Vec<Series> {
        let series = |trial: &str, first: usize, samples: usize| Series {
            trial: trial.into(),
            time: vec![0.0; samples],
            elapsed: vec![0.0; samples],
            inputs: DMatrix::from_fn(samples, 2, |t, c| (100 * c + first + t) as f64),
            target: DMatrix::zeros(samples, 1),
            nominal: DMatrix::zeros(samples, 1),
            measured: DMatrix::zeros(samples, 1),
            segments: vec![0..samples],
            slopes: DMatrix::zeros(0, 0),
        };
        vec![series("a", 0, 30), series("b", 30, 20)]
    }

    /// Oracle: the sorted values are what they were; a column that was not named is untouched.
    #[test]
    fn all_values_stay_and_change_places_across_trials() {
        let (before, mut after) = (part(), part());
        shuffle(&mut after, 0, "q");
        assert_eq!(all(&before, 1), all(&after, 1));
        let mut sorted = all(&after, 0);
        assert_ne!(all(&before, 0), sorted);
        assert!(after[0].inputs.column(0).iter().any(|&value| value >= 30.0), "nothing came from the other trial");
        sorted.sort_by(f64::total_cmp);
        assert_eq!(all(&before, 0), sorted);
        let mut again = part();
        shuffle(&mut again, 0, "q");
        assert_eq!(again, after);
    }
}
