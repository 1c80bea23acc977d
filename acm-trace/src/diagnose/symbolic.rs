//! A sparse formula for what no known effect explains.
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
//! Terms are added one by one: the dozen that reduce ‖r‖² most are scored on blocks left out, and of those that score
//! alike the simplest is taken; a term on an actuator moves all outputs at once and counts as simpler. Directions that
//! calibration absorbs can be taken out of r and of every term beforehand. Chen, Billings & Luo (1989), Int. J.
//! Control 50(5) (orthogonal least squares); Brunton, Proctor & Kutz (2016), PNAS 113(15) (sparse formulas).

use acm_core::display::significant;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::diagnose::library::{Term, terms};
use crate::diagnose::remainder::Remainder;
use crate::diagnose::samples::{Sample, residuals, samples};
use crate::finding::{Symbolic, SymbolicTerm};

/// Samples at most.
const MOST_SAMPLES: usize = 4000;

/// Terms at most.
const MOST_TERMS: usize = 4;

/// Terms that are scored on blocks left out, at each step.
const SHORT_LIST: usize = 16;

/// A further term takes this share of the mean square at least, and either this share of what the formula takes in
/// all, or a good part of what is left.
const LEAST_GAIN: f64 = 0.03;
const LEAST_PART: f64 = 0.02;
const GOOD_PART: f64 = 0.3;

/// All together take this share at least, by this many standard errors over the blocks (more where blocks are few).
const LEAST_TOTAL: f64 = 0.10;
const LEAST_ERRORS: f64 = 2.5;

/// Terms whose gains differ by less than this share of the best one score alike.
const ALIKE: f64 = 0.03;

/// What is left of a term beside the others, as a share of its mean square, below which it is rounding.
const RANK: f64 = 1e-6;

/// The formula, or none where nothing takes a tenth of the mean square on blocks left out. `absorbed` holds the
/// directions that calibration would take up: one matrix for each trial, [T·M × k] with rows as in its residual; or
/// nothing.
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

/// Mean square on blocks left out, and block by block.
struct Score {
    mean: f64,
    blocks: Vec<f64>,
}

impl Score {
    fn better_than(&self, other: &Self) -> bool {
        let gains: Vec<f64> = self.blocks.iter().zip(&other.blocks).map(|(mine, other)| other - mine).collect();
        let n = gains.len() as f64;
        let mean = gains.iter().sum::<f64>() / n;
        let spread = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
        mean > LEAST_ERRORS * (1.0 + 2.0 / n) * (spread / n).sqrt()
    }
}

struct Search {
    terms: Vec<Term>,
    actuators: usize,
    outputs: usize,
    /// Slopes [N×M×A] at the samples.
    slopes: Vec<f64>,
    /// [N×M], less what calibration absorbs.
    residual: Vec<f64>,
    /// Orthonormal directions that calibration absorbs.
    absorbed: Vec<Vec<f64>>,
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
            absorbed: basis(remainder, absorbed, &rows),
            blocks,
            floor: remainder.floor,
        };
        search.residual = without(search.residual, &search.absorbed);
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

    /// The simplest of those terms that score as well as the best one, and the mean square with it.
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

    /// Those (term, place) that reduce the sum of squares most, beside what is chosen.
    fn short_list(&self, chosen: &[Column]) -> Vec<(usize, usize)> {
        let mut directions = self.absorbed.clone();
        for column in chosen {
            directions.extend(direction(column.values.clone(), &directions));
        }
        let left = without(self.residual.clone(), &directions);
        let whole = self.squares();
        let mut norms = whole.clone();
        for direction in &directions {
            norms -= self.products(direction).map(|product| product * product);
        }
        let gains = self.products(&left).zip_zip_map(&whole, &norms, |product, whole, norm| {
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

    /// Inner products of every term at every place with a vector of N·M.
    fn products(&self, vector: &[f64]) -> DMatrix<f64> {
        let weight = |n: usize, place: usize| {
            (0..self.outputs).map(|m| self.weight(n, m, place) * vector[n * self.outputs + m]).sum()
        };
        self.summed(weight, |x| x)
    }

    /// Squared norms of every term at every place.
    fn squares(&self) -> DMatrix<f64> {
        let weight = |n: usize, place: usize| (0..self.outputs).map(|m| self.weight(n, m, place).powi(2)).sum();
        self.summed(weight, |x| x * x)
    }

    /// Σ_n of(φ(n)) · weight(n, place).
    fn summed(&self, weight: impl Fn(usize, usize) -> f64, of: fn(f64) -> f64) -> DMatrix<f64> {
        let samples = self.residual.len() / self.outputs;
        let weights = DMatrix::from_fn(samples, self.actuators + self.outputs, weight);
        let rows: Vec<Vec<f64>> = self
            .terms
            .par_iter()
            .map(|term| {
                let sum = |column: &[f64]| term.values.iter().zip(column).map(|(x, w)| of(*x) * w).sum();
                weights.as_slice().chunks_exact(samples).map(sum).collect()
            })
            .collect();
        DMatrix::from_fn(rows.len(), weights.ncols(), |term, place| rows[term][place])
    }

    /// How a term at `place` moves output `m`.
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

    fn score(&self, chosen: &[Column]) -> Score {
        self.score_of(chosen, None)
    }

    /// Fitted to all blocks but one, scored on that one.
    fn score_of(&self, chosen: &[Column], further: Option<&Column>) -> Score {
        let columns: Vec<&Column> = chosen.iter().chain(further).collect();
        let parts: Vec<Normal> = self.blocks.iter().map(|block| self.normal(&columns, block)).collect();
        let all = parts.iter().skip(1).fold(parts[0].clone(), |sum, part| sum.plus(part));
        let left: Vec<f64> = parts
            .iter()
            .map(|part| {
                let coefficients = all.less(part).solve();
                part.squares - 2.0 * coefficients.dot(&part.right) + coefficients.dot(&(&part.gram * &coefficients))
            })
            .collect();
        let samples: usize = self.blocks.iter().map(Vec::len).sum();
        let blocks = left.iter().zip(&self.blocks).map(|(sum, block)| sum / block.len() as f64).collect();
        Score { mean: left.iter().sum::<f64>() / samples as f64, blocks }
    }

    fn normal(&self, columns: &[&Column], block: &[usize]) -> Normal {
        let dot = |a: &[f64], b: &[f64]| -> f64 {
            let of = |n: usize| (n * self.outputs..(n + 1) * self.outputs).map(|k| a[k] * b[k]).sum::<f64>();
            block.iter().map(|&n| of(n)).sum()
        };
        let (k, r) = (columns.len(), &self.residual);
        Normal {
            gram: DMatrix::from_fn(k, k, |i, j| dot(&columns[i].values, &columns[j].values)),
            right: DVector::from_fn(k, |i, _| dot(&columns[i].values, r)),
            squares: dot(r, r),
        }
    }

    /// Without terms that later ones have made idle.
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

    fn formula(&self, remainder: &Remainder, chosen: &[Column], mean_square: f64) -> Symbolic {
        let all: Vec<usize> = self.blocks.concat();
        let coefficients = self.normal(&chosen.iter().collect::<Vec<_>>(), &all).solve();
        let on = |place: usize| match remainder.rig.actuators.get(place) {
            Some(actuator) => format!("Δ{}", actuator.name),
            None => format!("Δ{}", remainder.rig.outputs[place - self.actuators].name),
        };
        let mut places: Vec<usize> = chosen.iter().map(|column| column.place).collect();
        places.sort_unstable();
        places.dedup();
        let terms = chosen.iter().zip(coefficients.iter()).map(|(column, a)| {
            let term = &self.terms[column.term];
            SymbolicTerm { on: on(column.place), term: term.name.clone(), coefficient: a / term.scale }
        });
        let terms: Vec<SymbolicTerm> = terms.collect();
        let lines: Vec<String> = places.iter().map(|&place| line(&on(place), &terms)).collect();
        Symbolic { formula: lines.join(", "), error: mean_square.max(0.0).sqrt(), terms }
    }
}

/// `Δq1 = −0.0903·q1·q2 + 0.0200·t`.
fn line(on: &str, terms: &[SymbolicTerm]) -> String {
    let mut text = String::new();
    for term in terms.iter().filter(|term| term.on == on) {
        let (value, first) = (significant(term.coefficient.abs(), 3), text.is_empty());
        text += match (first, term.coefficient < 0.0) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        };
        text += &if term.term == "1" { value } else { format!("{value}·{}", term.term) };
    }
    format!("{on} = {text}")
}

/// Normal equations of a few columns.
#[derive(Clone)]
struct Normal {
    gram: DMatrix<f64>,
    right: DVector<f64>,
    squares: f64,
}

impl Normal {
    fn plus(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram + &other.gram,
            right: &self.right + &other.right,
            squares: self.squares + other.squares,
        }
    }

    fn less(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram - &other.gram,
            right: &self.right - &other.right,
            squares: self.squares - other.squares,
        }
    }

    /// Coefficients; a column that is nothing beside the others gets none.
    fn solve(mut self) -> DVector<f64> {
        let scale: Vec<f64> = (0..self.right.len()).map(|k| self.gram[(k, k)].sqrt().max(f64::MIN_POSITIVE)).collect();
        for i in 0..scale.len() {
            self.right[i] /= scale[i];
            for j in 0..scale.len() {
                self.gram[(i, j)] /= scale[i] * scale[j];
            }
            self.gram[(i, i)] += 1e-9;
        }
        let solution = self.gram.cholesky().map(|factor| factor.solve(&self.right));
        let mut solution = solution.unwrap_or_else(|| DVector::zeros(scale.len()));
        solution.iter_mut().zip(&scale).for_each(|(x, scale)| *x /= scale);
        solution
    }
}

/// Slopes at the samples; what is not finite moves nothing.
fn slopes(remainder: &Remainder, rows: &[Sample]) -> Vec<f64> {
    let width = remainder.outputs() * remainder.rig.actuators.len();
    let row = |s: &Sample| &remainder.trials[s.trial].slopes[s.t * width..(s.t + 1) * width];
    rows.iter().flat_map(row).map(|slope| if slope.is_finite() { *slope } else { 0.0 }).collect()
}

/// Orthonormal directions of what calibration absorbs, at the samples.
fn basis(remainder: &Remainder, absorbed: &[DMatrix<f64>], rows: &[Sample]) -> Vec<Vec<f64>> {
    let (outputs, count) = (remainder.outputs(), absorbed.first().map_or(0, DMatrix::ncols));
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for k in 0..count {
        let places = rows.iter().flat_map(|s| (0..outputs).map(move |m| (s.trial, s.t * outputs + m)));
        let vector = places.map(|(trial, row)| absorbed[trial][(row, k)]).collect();
        directions.extend(direction(vector, &directions));
    }
    directions
}

/// Unit vector of what is left of `vector` beside orthonormal `others`; none where that is rounding.
fn direction(vector: Vec<f64>, others: &[Vec<f64>]) -> Option<Vec<f64>> {
    let whole = norm(&vector);
    // Twice, because once leaves rounding of the size of what was taken away.
    let left = without(without(vector, others), others);
    let norm = norm(&left);
    (norm > RANK * whole).then(|| left.into_iter().map(|x| x / norm).collect())
}

fn without(mut vector: Vec<f64>, directions: &[Vec<f64>]) -> Vec<f64> {
    for direction in directions {
        let along: f64 = vector.iter().zip(direction).map(|(x, d)| x * d).sum();
        vector.iter_mut().zip(direction).for_each(|(x, d)| *x -= along * d);
    }
    vector
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
