//! Unrecorded quantities, projected out of every column of a trial: an unknown initial state, and a share of the mean.
//!
//! ```text
//! x̃ = x − h (hᵀx)/(hᵀh (1 + δ)),   h_k = e^{−(t_k − t_0)/τ}
//! ```
//!
//! | symbol | meaning                                                                       | unit |
//! | `τ`    | longest memory of the effects, or the time that is forgiven where it is longer | s    |
//! | `δ`    | prior of the state, relative to its information                               | 1    |
//!
//! A state is forgotten only where it outlasts the warm-up. The mean is that of [`offsets`](super::offsets).

use nalgebra::{DMatrix, DVector};

use super::offsets::without_offset;
use super::problem::Problem;
use super::state::{State, longest_memory};

/// Duration of a memory, as a share of the warm-up, from which its state at the start matters.
const LASTS: f64 = 0.3;

/// Prior weight δ.
const PRIOR: f64 = 1e-3;

/// Projection of one trial; see the head of this file.
pub struct Unrecorded {
    /// Memory τ and h; none where the state at the start has faded within the warm-up.
    start: Option<(f64, DVector<f64>)>,
    offset_share: f64,
}

impl Unrecorded {
    /// Returns the model of trial `s`.
    pub fn new(problem: &Problem, state: &State, s: usize) -> Self {
        let (series, kept) = (&problem.series[s], &problem.kept[s]);
        let first = kept.first().map_or(0.0, |&k| series.thin.time[k]);
        let lasts = |tau: &f64| tau.is_finite() && *tau > LASTS * (first - series.record.time[0]);
        let memory = longest_memory(state).map_or(state.forgiven, |memory| memory.max(state.forgiven));
        let decay = |tau: f64| {
            let h = kept.iter().map(|&k| (-(series.thin.time[k] - first) / tau).exp());
            (tau, DVector::from_iterator(kept.len(), h))
        };
        let start = Some(memory).filter(lasts).map(decay).filter(|(_, h)| h.norm_squared() > 0.0);
        Self { start, offset_share: problem.offset_share }
    }

    /// Returns τ; 0 where the state at the start has faded within the warm-up.
    pub fn memory(&self) -> f64 {
        self.start.as_ref().map_or(0.0, |(tau, _)| *tau)
    }

    /// Returns x̃ of each column.
    pub fn taken_out(&self, columns: DMatrix<f64>) -> DMatrix<f64> {
        let rest = match &self.start {
            Some((_, h)) => {
                let along = columns.tr_mul(h) / (h.norm_squared() * (1.0 + PRIOR));
                columns - h * along.transpose()
            }
            None => columns,
        };
        without_offset(self.offset_share, rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: what decays as a forgotten state does is gone but for the prior, and what is orthogonal to it stays.
    #[test]
    fn a_state_at_the_start_is_taken_out() {
        let h = DVector::from_fn(50, |k, _| (-0.1 * k as f64).exp());
        let across = DVector::from_fn(50, |k, _| (0.7 * k as f64).sin());
        let across = &across - &h * (h.dot(&across) / h.norm_squared());
        let unrecorded = Unrecorded { start: Some((1.0, h.clone())), offset_share: 0.0 };
        let left = unrecorded.taken_out(DMatrix::from_columns(&[&h * 3.0, across.clone()]));
        assert!(left.column(0).norm() < 1.01 * PRIOR * 3.0 * h.norm());
        assert!((left.column(1) - across).norm() < 1e-12);
    }
}
