//! Unrecorded quantities, projected out of every column of a trial: an unknown initial state, and a share of the mean.
//!
//! ```text
//! x̃ = x − H (HᵀH + δ diag HᵀH)⁻¹ Hᵀ x,   H_ki = e^{−(t_k − t_0)/τ_i}
//! ```
//!
//! | symbol | meaning                                                                       | unit |
//! | `τ_i`  | memories of the effects, and those that are forgiven beside them               | s    |
//! | `δ`    | prior of the states, relative to their information                            | 1    |
//!
//! A state is forgotten only where it outlasts the warm-up. The mean is that of [`offsets`](super::offsets).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::offsets::without_offset;
use super::problem::Problem;
use super::state::{State, memories};

/// Duration of a memory, as a share of the warm-up, from which its state at the start matters.
const LASTS: f64 = 0.3;

/// Prior weight δ.
const PRIOR: f64 = 1e-3;

/// Projection of one trial; see the head of this file.
pub struct Unrecorded {
    /// Memories τ of the states that have not faded within the warm-up.
    memories: Vec<f64>,
    /// Factor L⁻¹Hᵀ with HᵀH + δ diag HᵀH = L Lᵀ; none without such a state.
    start: Option<DMatrix<f64>>,
    offset_share: f64,
}

impl Unrecorded {
    /// Returns the model of trial `s`.
    pub fn new(problem: &Problem, state: &State, s: usize) -> Self {
        let (series, kept) = (&problem.series[s], &problem.kept[s]);
        let first = kept.first().map_or(0.0, |&k| series.thin.time[k]);
        let lasts = |tau: &f64| *tau > LASTS * (first - series.record.time[0]);
        let memories: Vec<f64> = memories(state).into_iter().filter(lasts).collect();
        let since: Vec<f64> = kept.iter().map(|&k| series.thin.time[k] - first).collect();
        let start = projection(&fading(&since, &memories));
        Self { memories: if start.is_some() { memories } else { vec![] }, start, offset_share: problem.offset_share }
    }

    /// Returns the memories τ of the states that are taken out.
    pub fn memories(&self) -> &[f64] {
        &self.memories
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

/// Returns H: how each memory fades at these times.
pub fn fading(since: &[f64], memories: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(since.len(), memories.len(), |k, i| (-since[k] / memories[i]).exp())
}

/// Returns L⁻¹Hᵀ; none for no state, or one that has faded at once.
fn projection(h: &DMatrix<f64>) -> Option<DMatrix<f64>> {
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

    /// Oracle: what decays as forgotten states do is gone but for the prior, and what is orthogonal to them stays.
    #[test]
    fn states_at_the_start_are_taken_out() {
        let since: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
        let h = fading(&since, &[3.0, 0.5]);
        let across = DMatrix::from_fn(50, 1, |k, _| (0.7 * k as f64).sin());
        let across = &across - &h * h.clone().svd(true, true).solve(&across, 1e-12).unwrap();
        let unrecorded = Unrecorded { memories: vec![3.0, 0.5], start: projection(&h), offset_share: 0.0 };
        let both = h.column(0) * 3.0 - h.column(1) * 2.0;
        let left = unrecorded.taken_out(DMatrix::from_columns(&[both.clone(), across.column(0).into_owned()]));
        assert!(left.column(0).norm() < 10.0 * PRIOR * both.norm(), "{} {}", left.column(0).norm(), both.norm());
        assert!((left.column(1) - across.column(0)).norm() < 1e-9);
    }
}
