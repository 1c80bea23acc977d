//! Unrecorded quantities, projected out of every column of a trial: an unknown initial state, and a share of the mean.
//!
//! ```text
//! x̃ = x − H (HᵀH + δ diag HᵀH)⁻¹ Hᵀ x,   H_ki = e^{−(t_k − t_0)/τ_i},   or times cos ω_i (t_k − t_0) and sin ω_i (t_k − t_0)
//! ```
//!
//! | symbol | meaning                                                                       | unit |
//! | `τ_i`, `ω_i` | modes of the effects, and further ones of the state                         | s, rad/s |
//! | `δ`    | prior of the states, relative to their information                            | 1    |
//!
//! A mode is projected out only where it outlasts the warm-up. The mean is that of [`offsets`](super::offsets).

pub mod past;

use std::f64::consts::FRAC_PI_2;

use acm_core::effects::Mode;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::offsets::without_offset;
use super::problem::Problem;
use super::state::{State, modes};

/// Duration of a memory, as a share of the warm-up, above which its initial state matters.
const LASTS: f64 = 0.3;

/// Prior weight δ.
const PRIOR: f64 = 1e-3;

/// Projection of one trial; see the head of this file.
pub struct Unrecorded {
    /// Modes of the states that have not faded within the warm-up.
    modes: Vec<Mode>,
    /// Factor L⁻¹Hᵀ with HᵀH + δ diag HᵀH = L Lᵀ; none without such a state.
    start: Option<DMatrix<f64>>,
    offset_share: f64,
}

impl Unrecorded {
    /// Returns the projection of trial `s`.
    pub fn new(problem: &Problem, state: &State, s: usize) -> Self {
        let (series, kept) = (&problem.series[s], &problem.kept[s]);
        let first = kept.first().map_or(0.0, |&k| series.thin.time[k]);
        let lasts = |mode: &Mode| mode.memory > LASTS * (first - series.record.time[0]);
        let modes: Vec<Mode> = modes(state).into_iter().filter(lasts).collect();
        let since: Vec<f64> = kept.iter().map(|&k| series.thin.time[k] - first).collect();
        let start = projection(&fading(&since, &modes));
        Self { modes: if start.is_some() { modes } else { vec![] }, start, offset_share: problem.offset_share }
    }

    /// Returns the modes of the states that are taken out.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Returns a key that distinguishes projections of a trial.
    pub fn key(&self) -> Vec<f64> {
        self.modes.iter().flat_map(|mode| [mode.memory, mode.frequency]).collect()
    }

    /// Returns x̃ of each column.
    pub fn taken_out(&self, columns: DMatrix<f64>) -> DMatrix<f64> {
        let rest = match &self.start {
            Some(w) => {
                let along = w * &columns;
                columns - w.tr_mul(&along)
            }
            None => columns,
        };
        without_offset(self.offset_share, rest)
    }
}

/// Returns H: the decay of each mode at these times.
pub fn fading(since: &[f64], modes: &[Mode]) -> DMatrix<f64> {
    let phases = |mode: &Mode| if mode.frequency > 0.0 { vec![0.0, FRAC_PI_2] } else { vec![0.0] };
    let all: Vec<(Mode, f64)> =
        modes.iter().flat_map(|mode| phases(mode).into_iter().map(move |phase| (*mode, phase))).collect();
    DMatrix::from_fn(since.len(), all.len(), |k, i| {
        let (mode, phase) = all[i];
        (-since[k] / mode.memory).exp() * (mode.frequency * since[k] - phase).cos()
    })
}

/// Returns L⁻¹Hᵀ; none for no state, or one that decays at once.
pub fn projection(h: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    factor(h)?.l().solve_lower_triangular(&h.transpose())
}

/// Returns the states at the start that explain a residual best, (HᵀH + δ diag HᵀH)⁻¹ Hᵀ r.
pub fn states(h: &DMatrix<f64>, residual: &DVector<f64>) -> Option<DVector<f64>> {
    Some(factor(h)?.solve(&h.tr_mul(residual)))
}

fn factor(h: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let mut g = h.tr_mul(h);
    if g.is_empty() || !(g.diagonal().min() > 0.0) {
        return None;
    }
    (0..g.nrows()).for_each(|i| g[(i, i)] *= 1.0 + PRIOR);
    g.cholesky()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: A e^{−t/τ} cos(ωt + φ), by its formula.
    #[test]
    fn a_start_that_swings_is_taken_out() {
        let since: Vec<f64> = (0..80).map(|k| 0.05 * f64::from(k)).collect();
        let modes = vec![Mode { memory: 2.0, frequency: 7.0 }];
        let swing = DMatrix::from_fn(80, 1, |k, _| 3.0 * (-since[k] / 2.0).exp() * (7.0 * since[k] + 0.8).cos());
        let unrecorded = Unrecorded { start: projection(&fading(&since, &modes)), modes, offset_share: 0.0 };
        assert!(unrecorded.taken_out(swing.clone()).norm() < 10.0 * PRIOR * swing.norm());
    }

    /// Oracle: what decays as projected modes do is gone but for the prior, and what is orthogonal to them stays.
    #[test]
    fn states_at_the_start_are_taken_out() {
        let since: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
        let modes = [3.0, 0.5].map(|memory| Mode { memory, frequency: 0.0 }).to_vec();
        let h = fading(&since, &modes);
        let across = DMatrix::from_fn(50, 1, |k, _| (0.7 * k as f64).sin());
        let across = &across - &h * h.clone().svd(true, true).solve(&across, 1e-12).unwrap();
        let unrecorded = Unrecorded { modes, start: projection(&h), offset_share: 0.0 };
        let both = h.column(0) * 3.0 - h.column(1) * 2.0;
        let left = unrecorded.taken_out(DMatrix::from_columns(&[both.clone(), across.column(0).into_owned()]));
        assert!(left.column(0).norm() < 10.0 * PRIOR * both.norm(), "{} {}", left.column(0).norm(), both.norm());
        assert!((left.column(1) - across.column(0)).norm() < 1e-9);
    }
}
