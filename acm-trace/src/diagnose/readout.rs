//! Share of a residual that columns explain on blocks left out, against the same on surrogates.
//!
//! ```text
//! Ĉ   = argmin ‖Y − 1 ȳᵀ − X C‖² + λ ‖C‖²         on all blocks but one group
//! R²  = 1 − Σ ‖y − ȳ − Cᵀx‖² / Σ ‖y − ȳ‖²         on the groups left out, best of all settings
//! p   = (1 + #{R²(shifted) ≥ R²}) / (1 + B)
//! ```
//!
//! | symbol | meaning | shape |
//! | --- | --- | --- |
//! | `X` | columns, standardised | N × n |
//! | `Y` | residuals, and B shifted copies ([`crate::diagnose::shifted`]) | N × M (B + 1) |
//! | `λ` | ridge, as a share of N | 1 |
//! | `B` | number of shifted residuals | 1 |
//!
//! All are solved at once, with one factorisation for each group and setting. A setting is a λ with all columns or the plain ones. The
//! best is taken for each shifted residual too, which accounts for the choice. Stone (1974), J. R. Stat. Soc. B 36(2) (cross-validation).

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, samples};
use crate::diagnose::shifted::shifted;
use crate::finding::Probe;

/// Largest number of samples.
const MOST_SAMPLES: usize = 4000;

/// Most columns, and fewest samples for each column.
const MOST_COLUMNS: usize = 200;
const SAMPLES_PER_COLUMN: usize = 5;

/// Number of groups of blocks that are left out, one at a time.
const GROUPS: usize = 6;

/// Ridge parameters, as a share of the number of samples.
const RIDGES: [f64; 4] = [0.01, 0.06, 0.4, 3.0];

/// Smallest number of samples that a probe needs.
const FEWEST_SAMPLES: usize = 40;

/// Columns with mean 0 and variance 1.
pub(crate) struct Columns {
    /// Matrix X, one row for each sample.
    pub x: DMatrix<f64>,
    /// Number of columns, from the first, that are few and simple. They are a setting of their own, for weak
    /// dependences.
    pub plain: usize,
}

/// Tests whether columns predict the residual; `of` computes at most the given number of them at some samples. Where the data are too few,
/// it returns a probe that explains nothing, with p = 1.
pub(crate) fn readout(remainder: &Remainder, seed: u64, of: impl Fn(&[Sample], usize) -> Columns) -> Probe {
    let mut rows = samples(remainder, MOST_SAMPLES);
    rows.sort_by_key(|s| group(remainder, s));
    let bounds = bounds(&rows.iter().map(|s| group(remainder, s)).collect::<Vec<usize>>());
    if rows.len() < FEWEST_SAMPLES || bounds.len() < 2 {
        return Probe { explained: 0.0, by_chance: 0.0, p: 1.0, rms: 0.0 };
    }
    let columns = of(&rows, MOST_COLUMNS.min(rows.len() / SAMPLES_PER_COLUMN));
    let y = shifted(remainder, &rows, seed);
    judge(&errors(&columns, &y, &bounds), remainder.outputs(), rows.len())
}

/// Returns the group of a sample; neighbouring blocks are in different groups.
fn group(remainder: &Remainder, sample: &Sample) -> usize {
    sample.block % GROUPS.min(remainder.blocks().max(1))
}

/// Returns the ranges of equal values.
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

/// Sums over some rows.
#[derive(Clone)]
struct Sums {
    /// Products XᵀX, with a column of ones before X.
    gram: DMatrix<f64>,
    /// Products XᵀY.
    cross: DMatrix<f64>,
    /// Sum of squares of each column of Y.
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

fn errors(columns: &Columns, y: &DMatrix<f64>, groups: &[Range<usize>]) -> Errors {
    let sums: Vec<Sums> = groups.par_iter().map(|rows| Sums::of(&columns.x, y, rows)).collect();
    let mut all = sums[0].clone();
    for other in &sums[1..] {
        all.gram += &other.gram;
        all.cross += &other.cross;
        all.squares += &other.squares;
        all.count += other.count;
    }
    let settings: Vec<(usize, f64)> =
        [columns.plain, columns.x.ncols()].iter().flat_map(|&count| RIDGES.map(|ridge| (count, ridge))).collect();
    let tasks: Vec<(&Sums, (usize, f64))> =
        sums.iter().flat_map(|test| settings.iter().map(move |setting| (test, *setting))).collect();
    let scores: Vec<DVector<f64>> =
        tasks.par_iter().map(|(test, (count, ridge))| squared_errors(&all.less(test), test, *count, *ridge)).collect();
    let zero = || DVector::zeros(y.ncols());
    let total = sums.iter().map(|test| about_the_mean(&all.less(test), test)).fold(zero(), |sum, part| sum + part);
    let left = (0..settings.len())
        .map(|k| scores.iter().skip(k).step_by(settings.len()).fold(zero(), |sum, part| sum + part))
        .collect();
    Errors { total, left }
}

/// Returns the squared errors on `test` of the ridge regression of the first columns on `train`; infinite where it has
/// no solution.
fn squared_errors(train: &Sums, test: &Sums, count: usize, ridge: f64) -> DVector<f64> {
    let size = 1 + count;
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

/// Returns the squares on `test` about the mean of `train`.
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
