//! Correction of the actuators beside the tip, through the Jacobian of the arm.
//!
//! ```text
//! p_o = n_o + Σ_a S_oa n_{O+a}          S_oa = (∂y_o/∂q_a) d_a / s_o
//! ∂L/∂n_o = ∂L/∂p_o                     ∂L/∂n_{O+a} = Σ_o S_oa ∂L/∂p_o
//! ```
//!
//! | symbol | meaning                                                                        | shape     | unit         |
//! | ------ | ------------------------------------------------------------------------------ | --------- | ------------ |
//! | `n`    | the network's output: of the O outputs, then of the A actuators               | `[N,O+A]` | standardised |
//! | `p`    | prediction of the residual                                                     | `[N,O]`   | standardised |
//! | `∂y/∂q` | slopes of the nominal model at the sample                                     | `[N,O,A]` | m per unit of q |
//! | `s`    | spread of the residual in training                                             | `[O]`     | m            |
//! | `d`    | change of an actuator that moves the outputs by their spread, root mean square in training | `[A]` | unit of q |
//!
//! The arm is taken as linear about the recorded actuators: corrections are small beside the motion.

use acm_datasets::{Series, Standardizer};

/// Sums for the scales of the actuators.
#[derive(Debug, Default)]
pub struct SlopeSums {
    squares: Vec<f64>,
    count: usize,
}

impl SlopeSums {
    /// Adds a series, whose residual has the spread of `targets`.
    pub fn add(&mut self, series: &Series, targets: &Standardizer) {
        let outputs = targets.spread.len();
        let actuators = series.slopes.ncols() / outputs;
        self.squares.resize(actuators, 0.0);
        for row in series.slopes.row_iter() {
            for (place, slope) in row.iter().enumerate() {
                self.squares[place % actuators] += (slope / targets.spread[place / actuators]).powi(2);
            }
        }
        self.count += series.slopes.nrows() * outputs;
    }

    /// Returns `d` of each actuator; 0 of one that moves nothing.
    pub fn scales(&self) -> Vec<f64> {
        let scale = |square: &f64| if *square > 0.0 { (self.count as f64 / square).sqrt() } else { 0.0 };
        self.squares.iter().map(scale).collect()
    }
}

/// Returns the slopes of a series times scales, [T×O×A] by rows.
pub fn standardised(series: &Series, targets: &Standardizer, scales: &[f64]) -> Vec<f32> {
    let actuators = scales.len();
    let one =
        |(place, slope): (usize, &f64)| (slope * scales[place % actuators] / targets.spread[place / actuators]) as f32;
    series.slopes.row_iter().flat_map(|row| row.iter().enumerate().map(one).collect::<Vec<f32>>()).collect()
}

/// Widths of corrections.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Widths {
    /// Number of outputs O.
    pub outputs: usize,
    /// Number of actuators A; 0 where the tip alone is corrected.
    pub actuators: usize,
}

impl Widths {
    /// Returns the number of the network's outputs.
    pub fn said(self) -> usize {
        self.outputs + self.actuators
    }

    /// Returns the predictions [N×O] of the network's output [N×(O+A)], with slopes [N×O×A].
    pub fn combined(self, said: &[f32], slopes: &[f32]) -> Vec<f32> {
        let rows = said.chunks_exact(self.said()).zip(slopes.chunks_exact(self.outputs * self.actuators));
        let row = |(said, slopes): (&[f32], &[f32])| {
            let (tip, moved) = said.split_at(self.outputs);
            let moves = |slopes: &[f32]| slopes.iter().zip(moved).map(|(s, n)| s * n).sum::<f32>();
            tip.iter().zip(slopes.chunks_exact(self.actuators)).map(|(n, s)| n + moves(s)).collect::<Vec<f32>>()
        };
        rows.flat_map(row).collect()
    }

    /// Computes the derivatives by the network's output [N×(O+A)], from those by the predictions [N×O].
    pub fn derivatives(self, by_prediction: &[f32], slopes: &[f32], by_said: &mut [f32]) {
        let rows = by_prediction.chunks_exact(self.outputs).zip(slopes.chunks_exact(self.outputs * self.actuators));
        for ((by_prediction, slopes), by_said) in rows.zip(by_said.chunks_exact_mut(self.said())) {
            let (tip, moved) = by_said.split_at_mut(self.outputs);
            tip.copy_from_slice(by_prediction);
            for (a, moved) in moved.iter_mut().enumerate() {
                *moved = by_prediction.iter().enumerate().map(|(o, d)| slopes[o * self.actuators + a] * d).sum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTHS: Widths = Widths { outputs: 2, actuators: 1 };

    /// Oracle: by hand.
    #[test]
    fn an_actuator_moves_the_outputs_by_its_slopes() {
        let (said, slopes) = ([1.0, 2.0, 10.0, 0.5, 0.5, -1.0], [0.5, -2.0, 3.0, 4.0]);
        assert_eq!(WIDTHS.combined(&said, &slopes), [6.0, -18.0, -2.5, -3.5]);
    }

    /// Oracle: the sum of p·g is linear in n, so that its derivative is its change by a unit of one n.
    #[test]
    fn derivatives_are_the_change_by_a_unit() {
        let (said, slopes, g) = ([1.0, 2.0, 10.0, 0.5, 0.5, -1.0], [0.5, -2.0, 3.0, 4.0], [1.0, -1.0, 0.5, 2.0]);
        let value = |said: &[f32]| -> f32 { WIDTHS.combined(said, &slopes).iter().zip(&g).map(|(p, g)| p * g).sum() };
        let mut found = [0.0; 6];
        WIDTHS.derivatives(&g, &slopes, &mut found);
        for k in 0..6 {
            let mut next = said;
            next[k] += 1.0;
            assert_eq!(found[k], value(&next) - value(&said), "{k}");
        }
    }
}
