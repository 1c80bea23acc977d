//! Normal equations of a fit, block by block, so that a block can be left out by subtraction.
//!
//! ```text
//! (Σ_b H_b + σ²Λ) d = −(Σ_b g_b + σ²Λ (δ − δ_0)),   H_b = J_bᵀJ_b,   g_b = J_bᵀ r_b
//! ```

use nalgebra::{DMatrix, DVector};

/// H and g of one block, its sum of squares, and its samples that count.
#[derive(Debug, Clone)]
pub struct Block {
    /// n × n.
    pub normal: DMatrix<f64>,
    /// n.
    pub gradient: DVector<f64>,
    /// ‖r‖².
    pub cost: f64,
    /// Samples.
    pub count: usize,
}

impl Block {
    /// Nothing, for n unknowns.
    pub fn empty(unknowns: usize) -> Self {
        Self { normal: DMatrix::zeros(unknowns, unknowns), gradient: DVector::zeros(unknowns), cost: 0.0, count: 0 }
    }

    /// Adds another block.
    pub fn add(&mut self, other: &Block) {
        self.normal += &other.normal;
        self.gradient += &other.gradient;
        self.cost += other.cost;
        self.count += other.count;
    }
}

/// Step −H⁻¹g over the unknowns that may move, each scaled to unit diagonal and damped; zero for the others.
pub fn step(normal: &DMatrix<f64>, gradient: &DVector<f64>, moves: &[bool], damping: f64) -> DVector<f64> {
    let active: Vec<usize> = (0..moves.len()).filter(|&j| moves[j] && normal[(j, j)] > 0.0).collect();
    let scale: Vec<f64> = active.iter().map(|&j| 1.0 / normal[(j, j)].sqrt()).collect();
    let n = active.len();
    let mut scaled = DMatrix::from_fn(n, n, |a, b| normal[(active[a], active[b])] * scale[a] * scale[b]);
    // Directions that the data do not determine stay where they are.
    (0..n).for_each(|a| scaled[(a, a)] += damping.max(1e-9));
    let right = DVector::from_fn(n, |a, _| -gradient[active[a]] * scale[a]);
    let mut step = DVector::zeros(moves.len());
    let Some(factor) = scaled.cholesky() else { return step };
    let solution = factor.solve(&right);
    active.iter().zip(&scale).zip(solution.iter()).for_each(|((&j, scale), x)| step[j] = x * scale);
    step
}
