//! Degree of a polynomial map from actuators to outputs, by blocks of samples left out in turn.
//!
//! ```text
//! e_d,b = Σ_o ‖p_b,o − p̂_d,b,o‖² / (T_b s_o²)          p̂_d,b of degree d fitted without block b
//! ```
//!
//! | symbol | meaning                                                        | shape | unit        |
//! | ------ | -------------------------------------------------------------- | ----- | ----------- |
//! | `p, s` | measured outputs, and their standard deviations over all samples | `[T×O], [O]` | of the outputs |
//! | `e`    | mean squared error of degree d on block b; [`simplest`] chooses by it | –     | 1           |
//!
//! Blocks are runs of successive samples. An actuator that rests at L values allows degrees up to L − 2, and always 1: such a degree
//! is determined without any one of the values. Two values are distinct if an empty 64th of the actuator's range
//! lies between them; an actuator rests if at least half of these parts are empty.

use nalgebra::DMatrix;

use crate::actuation::monomial_count;
use crate::fitting::left_out::{BLOCKS, simplest};
use crate::fitting::observations::Observations;
use crate::polynomial::Polynomial;

/// Highest degree that is tried: of the map that was the default before degrees were chosen.
const HIGHEST: usize = 3;

/// Parts of an actuator's range; an empty one separates two values.
const BINS: usize = 64;

/// Samples that are compared; of more, every k-th.
const SAMPLES: usize = 4000;

/// Samples for each coefficient of a degree that is tried: fewer leave a fit to chance.
const SAMPLES_A_TERM: usize = 10;

/// Returns the degree of the polynomial map that predicts blocks left out about as well as the best, and is the lowest such.
pub fn degree(data: &Observations) -> usize {
    let every = data.actuators.nrows().div_ceil(SAMPLES).max(1);
    let rows: Vec<usize> = (0..data.actuators.nrows()).step_by(every).collect();
    let (q, p) = (data.actuators.select_rows(&rows), data.measured.select_rows(&rows));
    let most = (1..=HIGHEST).take_while(|&degree| degree == 1 || is_determined(&q, degree)).last().unwrap_or(1);
    let errors: Vec<Vec<f64>> = (1..=most).map(|degree| left_out(&q, &p, degree)).collect();
    1 + simplest(&errors)
}

/// Returns whether samples and values of the actuators determine a degree, also without one value.
fn is_determined(q: &DMatrix<f64>, degree: usize) -> bool {
    let enough = q.nrows() >= SAMPLES_A_TERM * (1 + monomial_count(q.ncols(), degree));
    enough && q.column_iter().all(|column| levels(column.as_slice()).is_none_or(|levels| levels >= degree + 2))
}

/// Returns the number of values that an actuator rests at; `None` if it moves through most of its range, or not at all.
fn levels(column: &[f64]) -> Option<usize> {
    let low = column.iter().copied().fold(f64::INFINITY, f64::min);
    let span = column.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    let mut occupied = [false; BINS];
    column.iter().for_each(|value| occupied[((value - low) / span * (BINS - 1) as f64).round() as usize % BINS] = true);
    let rests = span > 0.0 && 2 * occupied.iter().filter(|bin| **bin).count() <= BINS;
    let begins = |bin: &usize| occupied[*bin] && (*bin == 0 || !occupied[*bin - 1]);
    rests.then(|| (0..BINS).filter(begins).count())
}

/// Returns the mean squared error of each block by the polynomial of the others, outputs in units of their spread.
fn left_out(q: &DMatrix<f64>, p: &DMatrix<f64>, degree: usize) -> Vec<f64> {
    let samples = q.nrows();
    let spread: Vec<f64> =
        p.column_iter().map(|column| column.variance()).map(|v| if v > 0.0 { v } else { 1.0 }).collect();
    let block = |b: usize| {
        let own = b * samples / BLOCKS..(b + 1) * samples / BLOCKS;
        let others: Vec<usize> = (0..samples).filter(|row| !own.contains(row)).collect();
        let fitted = Polynomial::fit(&q.select_rows(&others), &p.select_rows(&others), degree).polynomial;
        let (q, p) = (q.rows_range(own.clone()).into_owned(), p.rows_range(own.clone()));
        let error = p - fitted.predict(&q);
        let squares = error.column_iter().zip(&spread).map(|(e, s)| e.norm_squared() / s);
        squares.sum::<f64>() / own.len().max(1) as f64
    };
    (0..BLOCKS).map(block).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the degree that the data are made with. The noise repeats after 7 samples, the actuators after 19 and 31.
    fn made(of: impl Fn(f64, f64) -> f64) -> usize {
        let q = DMatrix::from_fn(600, 2, |t, a| ((t % [19, 31][a]) as f64 / [19.0, 31.0][a]) - 0.5);
        let noise = |t: usize| 0.02 * [0.3, -1.1, 0.8, 0.1, -0.6, 1.2, -0.7][t % 7];
        let measured = DMatrix::from_fn(600, 1, |t, _| of(q[(t, 0)], q[(t, 1)]) + noise(t));
        degree(&Observations { actuators: q, measured, at: vec![] })
    }

    #[test]
    fn the_degree_of_the_data_is_chosen() {
        assert_eq!(made(|a, b| a - 2.0 * b), 1);
        assert_eq!(made(|a, b| a * b + b), 2);
        assert_eq!(made(|a, b| a * a * a - a * b), 3);
    }

    /// Three values of an actuator, which it holds to a hundredth, determine a parabola, and none of them can be left out.
    #[test]
    fn few_values_allow_a_straight_line() {
        let q =
            DMatrix::from_fn(
                600,
                2,
                |t, a| if a == 0 { (t % 23) as f64 } else { (t / 200) as f64 + 0.01 * (t % 2) as f64 },
            );
        let measured = DMatrix::from_fn(600, 1, |t, _| q[(t, 1)].powi(2) + 0.01 * q[(t, 0)].powi(2));
        assert_eq!(degree(&Observations { actuators: q, measured, at: vec![] }), 1);
    }
}
