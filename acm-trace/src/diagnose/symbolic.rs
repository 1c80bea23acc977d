//! A sparse formula for the residual that no known effect explains.
//!
//! ```text
//! r = Σ_k a_k · φ_k(q, v, c, t) · ∂y/∂q_i      on an actuator: Δq_i = a_k φ_k
//!   + Σ_k a_k · φ_k(q, v, c, t) · e_m          on an output:   Δy_m = a_k φ_k
//! ```
//!
//! | symbol | meaning | unit |
//! | --- | --- | --- |
//! | `r` | residual | of the outputs |
//! | `φ` | a term of [`crate::diagnose::library`] | SI |
//! | `a` | coefficient | SI |
//!
//! Terms are added one by one: the 16 that reduce ‖r‖² most are scored on blocks left out, and of those that score
//! alike the simplest is taken; a term on an actuator moves all outputs at once and counts as simpler. Directions that
//! calibration absorbs can be taken out of r and of every term beforehand. Chen, Billings & Luo (1989), Int. J.
//! Control 50(5) (orthogonal least squares); Brunton, Proctor & Kutz (2016), PNAS 113(15) (sparse formulas).

mod normal;
mod orthogonal;
mod products;
mod score;
mod written;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::diagnose::library::{Term, terms};
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, residuals, samples};
use crate::finding::Symbolic;
use orthogonal::{RANK, basis, direction, without};

/// Largest number of samples.
const MOST_SAMPLES: usize = 4000;

/// Largest number of terms.
const MOST_TERMS: usize = 4;

/// Number of terms that are scored on blocks left out, at each step.
const SHORT_LIST: usize = 16;

/// Smallest share of the mean square that a further term explains. It must also explain either a share of the whole
/// formula's part, or a good part of the remainder.
const LEAST_GAIN: f64 = 0.03;
const LEAST_PART: f64 = 0.02;
const GOOD_PART: f64 = 0.3;

/// Smallest share that all terms together explain.
const LEAST_TOTAL: f64 = 0.10;

/// Differences of gains, as a share of the best, below which terms score alike.
const ALIKE: f64 = 0.03;

/// Returns the formula, or none where no formula explains a tenth of the mean square on blocks left out. `absorbed`
/// holds the directions that calibration would absorb: one matrix for each trial, [T·M × k] with rows as in its
/// residual; or nothing.
pub fn symbolic(remainder: &Remainder, absorbed: &[DMatrix<f64>]) -> Option<Symbolic> {
    let search = Search::new(remainder, absorbed)?;
    let chosen = search.prune(search.forward());
    let (start, end) = (search.score(&[]), search.score(&chosen));
    let enough = end.mean <= (1.0 - LEAST_TOTAL) * start.mean && end.better_than(&start);
    (enough && !chosen.is_empty()).then(|| search.formula(remainder, &chosen, end.mean))
}

/// A term at a place, as a column of N·M.
struct Column {
    term: usize,
    place: usize,
    values: Vec<f64>,
}

struct Search {
    terms: Vec<Term>,
    actuators: usize,
    outputs: usize,
    /// Slopes [N×M×A] at the samples.
    slopes: Vec<f64>,
    /// Residual [N×M], less what calibration absorbs.
    residual: Vec<f64>,
    /// Orthonormal directions that calibration absorbs.
    absorbed: Vec<Vec<f64>>,
    /// Squared norm of each term at each place: in all, and orthogonal to what calibration absorbs.
    squares: [DMatrix<f64>; 2],
    /// Samples of each block.
    blocks: Vec<Vec<usize>>,
    floor: f64,
}

impl Search {
    fn new(remainder: &Remainder, absorbed: &[DMatrix<f64>]) -> Option<Self> {
        let rows = samples(remainder, MOST_SAMPLES);
        let mut blocks = vec![Vec::new(); remainder.blocks()];
        rows.iter().enumerate().for_each(|(row, sample)| blocks[sample.block].push(row));
        blocks.retain(|block| !block.is_empty());
        let (actuators, outputs) = (remainder.rig.actuators.len(), remainder.outputs());
        let mut search = Self {
            terms: terms(remainder, &rows),
            actuators,
            outputs,
            slopes: slopes(remainder, &rows),
            residual: residuals(remainder, &rows),
            absorbed: basis(&at_samples(remainder, absorbed, &rows)),
            squares: [DMatrix::zeros(0, 0), DMatrix::zeros(0, 0)],
            blocks,
            floor: remainder.floor,
        };
        search.residual = without(search.residual, &search.absorbed);
        let whole = search.squares();
        let beside = &whole - search.squares_along(&search.absorbed);
        search.squares = [whole, beside];
        (search.blocks.len() > 1).then_some(search)
    }

    fn forward(&self) -> Vec<Column> {
        let mut chosen: Vec<Column> = Vec::new();
        let start = self.score(&[]).mean;
        let mut now = start;
        while chosen.len() < MOST_TERMS && now > 1.05 * self.floor.powi(2) {
            let Some((next, left)) = self.next(&chosen, now) else { break };
            let gain = now - left;
            if gain < LEAST_GAIN * now || gain < (LEAST_PART * (start - left)).min(GOOD_PART * now) {
                break;
            }
            chosen.push(next);
            now = left;
        }
        chosen
    }

    /// Returns the simplest of those terms that score as well as the best one, and the mean square with it.
    fn next(&self, chosen: &[Column], now: f64) -> Option<(Column, f64)> {
        let scored: Vec<(Column, f64)> = self
            .short_list(chosen)
            .into_par_iter()
            .map(|(term, place)| {
                let column = self.column(term, place);
                let left = self.score_of(chosen, Some(&column)).mean;
                (column, left)
            })
            .collect();
        let best = scored.iter().map(|(_, left)| *left).fold(f64::INFINITY, f64::min);
        let good = best + ALIKE * (now - best).max(0.0);
        let simplicity =
            |column: &Column| self.terms[column.term].factors + usize::from(column.place >= self.actuators);
        scored
            .into_iter()
            .filter(|(_, left)| *left <= good)
            .min_by(|(a, left), (b, right)| simplicity(a).cmp(&simplicity(b)).then(left.total_cmp(right)))
    }

    /// Returns the pairs (term, place) that reduce the sum of squares most, given the chosen ones.
    fn short_list(&self, chosen: &[Column]) -> Vec<(usize, usize)> {
        // Residual and columns are orthogonal to what calibration absorbs.
        let mut directions: Vec<Vec<f64>> = vec![];
        for column in chosen {
            directions.extend(direction(column.values.clone(), &directions));
        }
        let left = without(self.residual.clone(), &directions);
        let [whole, beside] = &self.squares;
        let norms = beside - self.squares_along(&directions);
        let gains = self.products(&left).zip_zip_map(whole, &norms, |product, whole, norm| {
            if norm > RANK * whole && whole > 0.0 { product * product / norm } else { 0.0 }
        });
        let mut list: Vec<(usize, usize)> = (0..gains.ncols())
            .flat_map(|place| (0..gains.nrows()).map(move |term| (term, place)))
            .filter(|&(term, place)| gains[(term, place)] > 0.0 && self.may_stand(term, place))
            .collect();
        list.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
        list.truncate(SHORT_LIST);
        list
    }

    fn may_stand(&self, term: usize, place: usize) -> bool {
        self.terms[term].may_stand((place < self.actuators).then_some(place), self.actuators)
    }

    /// Returns the effect of a term at `place` on output `m`.
    fn weight(&self, n: usize, m: usize, place: usize) -> f64 {
        if place < self.actuators {
            self.slopes[(n * self.outputs + m) * self.actuators + place]
        } else {
            f64::from(u8::from(place - self.actuators == m))
        }
    }

    fn column(&self, term: usize, place: usize) -> Column {
        let entry = |k: usize| {
            let (n, m) = (k / self.outputs, k % self.outputs);
            self.terms[term].values[n] * self.weight(n, m, place)
        };
        Column { term, place, values: without((0..self.residual.len()).map(entry).collect(), &self.absorbed) }
    }

    /// Removes terms that later terms have made unnecessary.
    fn prune(&self, mut chosen: Vec<Column>) -> Vec<Column> {
        let mut k = 0;
        while chosen.len() > 1 && k < chosen.len() {
            let now = self.score(&chosen).mean;
            let column = chosen.remove(k);
            if self.score(&chosen).mean > now / (1.0 - LEAST_GAIN) {
                chosen.insert(k, column);
                k += 1;
            }
        }
        chosen
    }
}

/// Returns the slopes at the samples; slopes that are not finite become zero.
fn slopes(remainder: &Remainder, rows: &[Sample]) -> Vec<f64> {
    let width = remainder.outputs() * remainder.rig.actuators.len();
    let row = |s: &Sample| &remainder.trials[s.trial].slopes[s.t * width..(s.t + 1) * width];
    rows.iter().flat_map(row).map(|slope| if slope.is_finite() { *slope } else { 0.0 }).collect()
}

/// Returns the directions that calibration absorbs, at the samples.
fn at_samples(remainder: &Remainder, absorbed: &[DMatrix<f64>], rows: &[Sample]) -> DMatrix<f64> {
    let (outputs, count) = (remainder.outputs(), absorbed.first().map_or(0, DMatrix::ncols));
    let entry = |k: usize, j: usize| {
        let sample = &rows[k / outputs];
        absorbed[sample.trial][(sample.t * outputs + k % outputs, j)]
    };
    DMatrix::from_fn(rows.len() * outputs, count, entry)
}
