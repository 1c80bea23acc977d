//! Is anything left that the recorded inputs predict, on blocks that took no part?
//!
//! ```text
//! Ĉ   = argmin ‖Y − 1 ȳᵀ − X C‖² + λ ‖C‖²         on all blocks but one group
//! R²  = 1 − Σ ‖y − ȳ − Cᵀx‖² / Σ ‖y − ȳ‖²         on the groups left out, best of all settings
//! p   = (1 + #{R²(shifted) ≥ R²}) / (1 + B)
//! ```
//!
//! | symbol | meaning | shape |
//! | --- | --- | --- |
//! | `X` | features ([`crate::diagnose::features`]), standardised | N × n |
//! | `Y` | residuals, and B times the same shifted | N × M (B + 1) |
//! | `λ` | ridge, as a share of N | 1 |
//! | `B` | number of shifted residuals | 1 |
//!
//! A shifted residual is that of another trial, begun elsewhere in time, with a random sign; where the trial ends it
//! runs back, because a jump from its end to its beginning would make it harder to predict than what was measured. It
//! keeps its own correlation in time and between outputs, and loses its tie to the inputs. All are solved at once,
//! from one factorisation for each group and setting. A setting is a λ, and all features or the plain ones among them;
//! the best is taken for each shifted residual as well, so that the choice is paid for. Theiler et al. (1992), Physica
//! D 58 (surrogate data); Stone (1974), J. R. Stat. Soc. B 36(2) (cross-validation).

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::diagnose::features::{Features, features};
use crate::diagnose::random::permutation;
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, residuals, samples};
use crate::finding::Probe;

/// Samples at most.
const MOST_SAMPLES: usize = 4000;

/// Features at most, and samples for each feature at least.
const MOST_FEATURES: usize = 200;
const SAMPLES_PER_FEATURE: usize = 5;

/// Groups of blocks that are left out, one at a time.
const GROUPS: usize = 6;

/// Ridge, as a share of the number of samples.
const RIDGES: [f64; 4] = [0.01, 0.06, 0.4, 3.0];

/// Columns of Y at most, and the smallest and largest number of residuals in them.
const MOST_COLUMNS: usize = 300;
const FEWEST_DRAWS: usize = 40;
const MOST_DRAWS: usize = 100;

/// Fewer samples than this say nothing.
const FEWEST_SAMPLES: usize = 40;

/// Whether the recorded inputs predict what is left. All but nothing explained, and p = 1, where there is too little
/// to tell.
pub fn probe(remainder: &Remainder, seed: u64) -> Probe {
    let mut rows = samples(remainder, MOST_SAMPLES);
    rows.sort_by_key(|s| group(remainder, s));
    let bounds = bounds(&rows.iter().map(|s| group(remainder, s)).collect::<Vec<usize>>());
    if rows.len() < FEWEST_SAMPLES || bounds.len() < 2 {
        return Probe { explained: 0.0, by_chance: 0.0, p: 1.0, rms: 0.0 };
    }
    let x = features(remainder, &rows, MOST_FEATURES.min(rows.len() / SAMPLES_PER_FEATURE), seed);
    let y = shifted(remainder, &rows, seed);
    judge(&errors(&x, &y, &bounds), remainder.outputs(), rows.len())
}

/// Neighbouring blocks go to different groups.
fn group(remainder: &Remainder, sample: &Sample) -> usize {
    sample.block % GROUPS.min(remainder.blocks().max(1))
}

/// Ranges of equal values.
fn bounds(groups: &[usize]) -> Vec<Range<usize>> {
    let mut start = 0;
    groups
        .chunk_by(|a, b| a == b)
        .map(|chunk| {
            start += chunk.len();
            start - chunk.len()..start
        })
        .collect()
}

/// Y of the header: M columns of the residual, then M of each shifted one.
fn shifted(remainder: &Remainder, rows: &[Sample], seed: u64) -> DMatrix<f64> {
    let outputs = remainder.outputs();
    let values = residuals(remainder, rows);
    let mut of_trial: Vec<Vec<usize>> = vec![Vec::new(); remainder.trials.len()];
    for (row, sample) in rows.iter().enumerate() {
        of_trial[sample.trial].push(row);
    }
    // Rows come group by group; within a trial they follow time.
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

/// An offset that is a tenth off at least, on the way there and back, and a sign.
fn turn(random: &mut ChaCha8Rng, length: usize) -> (usize, f64) {
    let least = length / 10;
    let offset = random.random_range(least..=2 * length - least);
    (offset, if random.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 })
}

/// Index in a trial that is run through forward, then backward, and so on.
fn mirrored(k: usize, length: usize) -> usize {
    let k = k % (2 * length);
    if k < length { k } else { 2 * length - 1 - k }
}

/// Sums over some rows.
#[derive(Clone)]
struct Sums {
    /// XᵀX, with a column of ones before X.
    gram: DMatrix<f64>,
    /// XᵀY.
    cross: DMatrix<f64>,
    /// Of squares of each column of Y.
    squares: DVector<f64>,
    count: f64,
}

impl Sums {
    fn of(x: &DMatrix<f64>, y: &DMatrix<f64>, rows: &Range<usize>) -> Self {
        let x = x.rows_range(rows.clone()).into_owned().insert_column(0, 1.0);
        let y = y.rows_range(rows.clone()).into_owned();
        let turned = x.transpose();
        let squares = DVector::from_iterator(y.ncols(), y.column_iter().map(|column| column.norm_squared()));
        Self { gram: &turned * &x, cross: &turned * &y, squares, count: rows.len() as f64 }
    }

    fn less(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram - &other.gram,
            cross: &self.cross - &other.cross,
            squares: &self.squares - &other.squares,
            count: self.count - other.count,
        }
    }
}

/// Squares about the mean, and squared errors with each setting, on rows left out: one for each column of Y.
struct Errors {
    total: DVector<f64>,
    left: Vec<DVector<f64>>,
}

fn errors(x: &Features, y: &DMatrix<f64>, groups: &[Range<usize>]) -> Errors {
    let sums: Vec<Sums> = groups.par_iter().map(|rows| Sums::of(&x.columns, y, rows)).collect();
    let mut all = sums[0].clone();
    for other in &sums[1..] {
        all.gram += &other.gram;
        all.cross += &other.cross;
        all.squares += &other.squares;
        all.count += other.count;
    }
    let settings: Vec<(usize, f64)> =
        [x.plain, x.columns.ncols()].iter().flat_map(|&columns| RIDGES.map(|ridge| (columns, ridge))).collect();
    let tasks: Vec<(&Sums, (usize, f64))> =
        sums.iter().flat_map(|test| settings.iter().map(move |setting| (test, *setting))).collect();
    let scores: Vec<DVector<f64>> = tasks
        .par_iter()
        .map(|(test, (columns, ridge))| squared_errors(&all.less(test), test, *columns, *ridge))
        .collect();
    let zero = || DVector::zeros(y.ncols());
    let total = sums.iter().map(|test| about_the_mean(&all.less(test), test)).fold(zero(), |sum, part| sum + part);
    let left = (0..settings.len())
        .map(|k| scores.iter().skip(k).step_by(settings.len()).fold(zero(), |sum, part| sum + part))
        .collect();
    Errors { total, left }
}

/// On `test`, with the ridge regression of the first columns on `train`; infinite where that has no solution.
fn squared_errors(train: &Sums, test: &Sums, columns: usize, ridge: f64) -> DVector<f64> {
    let size = 1 + columns;
    let mut damped = train.gram.view((0, 0), (size, size)).into_owned();
    for k in 1..size {
        damped[(k, k)] += ridge * train.count;
    }
    let Some(factor) = Cholesky::new(damped) else { return test.squares.map(|_| f64::INFINITY) };
    let coefficients = factor.solve(&train.cross.rows(0, size));
    let predicted = test.gram.view((0, 0), (size, size)) * &coefficients;
    let of = |k: usize| {
        let (c, b) = (coefficients.column(k), test.cross.column(k));
        test.squares[k] - 2.0 * c.dot(&b.rows(0, size)) + c.dot(&predicted.column(k))
    };
    DVector::from_fn(coefficients.ncols(), |k, _| of(k))
}

/// On `test`, with the mean of `train`.
fn about_the_mean(train: &Sums, test: &Sums) -> DVector<f64> {
    DVector::from_fn(train.cross.ncols(), |k, _| {
        let mean = train.cross[(0, k)] / train.count;
        test.squares[k] - 2.0 * mean * test.cross[(0, k)] + mean * mean * test.count
    })
}

fn judge(errors: &Errors, outputs: usize, samples: usize) -> Probe {
    let sum = |values: &DVector<f64>, draw: usize| values.rows(draw * outputs, outputs).sum();
    let gain = |draw: usize| {
        let total = sum(&errors.total, draw);
        let left = errors.left.iter().map(|left| sum(left, draw)).fold(f64::INFINITY, f64::min);
        if total > 0.0 { ((total - left) / total, total - left) } else { (0.0, 0.0) }
    };
    let (explained, removed) = gain(0);
    let mut chance: Vec<f64> = (1..errors.total.len() / outputs).map(|draw| gain(draw).0).collect();
    chance.sort_by(f64::total_cmp);
    let as_good = chance.iter().filter(|share| **share >= explained).count();
    // With B = 39: the second largest, so that what lies above has p ≤ 0.05.
    let rank = chance.len() - (chance.len() + 1) / 20;
    Probe {
        explained,
        by_chance: chance[rank],
        p: (1 + as_good) as f64 / (1 + chance.len()) as f64,
        rms: (removed / samples as f64).max(0.0).sqrt(),
    }
}
