//! Surrogates of a residual: the residual of another trial, shifted in time, with a random sign.
//!
//! A shifted trial is mirrored at its ends: a jump from its end to its beginning would make it harder to predict than the measured
//! residual. A surrogate keeps the correlation in time and between outputs, and loses the dependence on the inputs. Theiler et al. (1992),
//! Physica D 58.

use nalgebra::DMatrix;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::diagnose::random::permutation;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, residuals};

/// Most columns, and the smallest and largest number of residuals in them.
const MOST_COLUMNS: usize = 300;
const FEWEST_DRAWS: usize = 40;
const MOST_DRAWS: usize = 100;

/// Returns M columns of the residual at `rows`, then M of each surrogate.
pub(crate) fn shifted(remainder: &Remainder, rows: &[Sample], seed: u64) -> DMatrix<f64> {
    let outputs = remainder.outputs();
    let values = residuals(remainder, rows);
    let mut of_trial: Vec<Vec<usize>> = vec![Vec::new(); remainder.trials.len()];
    for (row, sample) in rows.iter().enumerate() {
        of_trial[sample.trial].push(row);
    }
    // Rows come group by group; within a trial they are sorted by time.
    of_trial.iter_mut().for_each(|trial| trial.sort_by_key(|&row| rows[row].t));
    of_trial.retain(|trial| !trial.is_empty());
    let draws = (MOST_COLUMNS / outputs.max(1) / 20 * 20).clamp(FEWEST_DRAWS, MOST_DRAWS);
    let mut y = DMatrix::zeros(rows.len(), outputs * draws);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(1);
    for draw in 0..draws {
        let order = if draw == 0 { (0..of_trial.len()).collect() } else { permutation(&mut random, of_trial.len()) };
        for (trial, from) in of_trial.iter().zip(order) {
            let from = &of_trial[from];
            let (offset, sign) = if draw == 0 { (0, 1.0) } else { turn(&mut random, from.len()) };
            for (k, &row) in trial.iter().enumerate() {
                let source = from[mirrored(k + offset, from.len())];
                for m in 0..outputs {
                    y[(row, draw * outputs + m)] = sign * values[source * outputs + m];
                }
            }
        }
    }
    y
}

/// Returns a random offset, at least a tenth of the trial away from zero, and a sign.
fn turn(random: &mut ChaCha8Rng, length: usize) -> (usize, f64) {
    let least = length / 10;
    let offset = random.random_range(least..=2 * length - least);
    (offset, if random.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 })
}

/// Returns the index in a trial traversed forward, then backward, and so on.
fn mirrored(k: usize, length: usize) -> usize {
    let k = k % (2 * length);
    if k < length { k } else { 2 * length - 1 - k }
}
