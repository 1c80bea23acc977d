//! Matrix times one sample: here the lanes of a vector are outputs.
//!
//! ```text
//! y[o] = Σ_k w[o,k] x[k]
//! ```
//!
//! | symbol | meaning                                              | shape                     |
//! | ------ | ---------------------------------------------------- | ------------------------- |
//! | `x`    | features                                             | [K]                       |
//! | `y`    | outputs in blocks, each filled up to whole rows      | [blocks][rows of a block] |
//! | `w`    | weights as y lies, once for each feature             | [K][rows of y]            |
//!
//! Eight vectors are summed at a time: of different outputs if there are as many, else of every second,
//! fourth … feature, so that one addition need not wait for another.

use pulp::Simd;

use crate::matrix::Matrix;
use crate::vectors::row::{ROWS, Row, vectors};

/// A matrix laid out for one sample.
#[derive(Clone, Debug)]
pub(crate) struct Spread {
    weights: Vec<Row>,
    outputs: usize,
}

impl Spread {
    /// Lays out a matrix whose rows are blocks of `unit`.
    pub fn new(matrix: &Matrix, unit: usize, parameters: &[f32]) -> Self {
        let rows = rows(unit);
        let outputs = matrix.rows / unit * rows;
        let mut weights = vec![Row::ZERO; matrix.columns * outputs];
        matrix.entries(|row, column, parameter| {
            let lane = row % unit;
            let at = column * outputs + row / unit * rows + lane / ROWS;
            weights[at].0[lane % ROWS] += parameters[parameter];
        });
        Self { weights, outputs }
    }

    /// Returns the number of outputs y.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Computes y = w x.
    #[inline(always)]
    pub fn times<S: Simd>(&self, s: S, x: &[f32], y: &mut [Row]) {
        let all = self.outputs * vectors::<S>();
        let mut first = 0;
        while first < all {
            first += match all - first {
                8.. => self.tile::<S, 8, 1>(s, x, y, first),
                4.. => self.tile::<S, 4, 2>(s, x, y, first),
                _ => self.tile::<S, 2, 4>(s, x, y, first),
            };
        }
    }

    /// Computes V vectors of y, each as U sums; returns V.
    #[inline(always)]
    fn tile<S: Simd, const V: usize, const U: usize>(&self, s: S, x: &[f32], y: &mut [Row], first: usize) -> usize {
        let mut sums = [[s.splat_f32s(0.0); V]; U];
        let weight =
            |row: &[Row], n: usize| row[(first + n) / vectors::<S>()].vectors::<S>()[(first + n) % vectors::<S>()];
        let mut weights = self.weights.chunks_exact(self.outputs);
        let (groups, rest) = x.as_chunks::<U>();
        for group in groups {
            for u in 0..U {
                let Some(row) = weights.next() else { break };
                let x = s.splat_f32s(group[u]);
                for n in 0..V {
                    sums[u][n] = s.mul_add_e_f32s(weight(row, n), x, sums[u][n]);
                }
            }
        }
        for (row, &x) in weights.zip(rest) {
            for n in 0..V {
                sums[0][n] = s.mul_add_e_f32s(weight(row, n), s.splat_f32s(x), sums[0][n]);
            }
        }
        for n in 0..V {
            let mut sum = sums[0][n];
            for u in 1..U {
                sum = s.add_f32s(sum, sums[u][n]);
            }
            let at = first + n;
            y[at / vectors::<S>()].vectors_mut::<S>()[at % vectors::<S>()] = sum;
        }
        V
    }
}

/// Returns the number of rows that hold `unit` numbers side by side.
pub(crate) fn rows(unit: usize) -> usize {
    unit.div_ceil(ROWS)
}

/// Copies numbers side by side into rows; the rest of the last row is unchanged.
pub(crate) fn spread(values: &[f32], rows: &mut [Row]) {
    for (values, row) in values.chunks(ROWS).zip(rows) {
        row.0[..values.len()].copy_from_slice(values);
    }
}

/// Copies rows into numbers side by side.
#[inline(always)]
pub(crate) fn collect(rows: &[Row], values: &mut [f32]) {
    for (values, row) in values.chunks_mut(ROWS).zip(rows) {
        values.copy_from_slice(&row.0[..values.len()]);
    }
}
