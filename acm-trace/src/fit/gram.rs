//! Products of a design, block by block: a refit without a fold is one sum and one solution.
//!
//! ```text
//! A = Σ_{b∉f} XᵀX + λ n_f D,   B_m = Σ XᵀZ_m,   S = Σ_m (Σ Z_mᵀZ_m − B_mᵀA⁻¹B_m)
//! α = S⁻¹ Σ_m (Σ Z_mᵀy_m − B_mᵀA⁻¹ Σ Xᵀy_m),   β_m = A⁻¹(Σ Xᵀy_m − B_m α)
//! loss_b = Σ_m ‖y_m − X β_m − Z_m α‖² over the rows of b ∈ f
//! ```
//!
//! Columns are scaled to unit mean square first, so that λ has no unit.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::blocks::Blocks;
use super::design::Design;
use crate::tall::product;

/// Products of one design with its targets.
#[derive(Debug, Clone)]
pub struct Grams {
    /// Products of each block.
    parts: Vec<Products>,
    /// Root mean square of each column of X, and of each Z.
    scale: (DVector<f64>, DVector<f64>),
    /// Ones for the columns that the ridge shrinks, else zeros.
    shrunk: DVector<f64>,
}

/// Products over some rows.
#[derive(Debug, Clone)]
struct Products {
    /// Products XᵀX, p × p.
    g: DMatrix<f64>,
    /// Products XᵀY, p × M.
    h: DMatrix<f64>,
    /// Squared norms ‖y‖² of each column.
    yy: DVector<f64>,
    /// Products XᵀZ_m, output by output, p × M c.
    b: DMatrix<f64>,
    /// Sums Σ_m Z_mᵀZ_m, c × c.
    zz: DMatrix<f64>,
    /// Sums Σ_m Z_mᵀy_m, c.
    zy: DVector<f64>,
    rows: usize,
}

/// Coefficients: β p × M, α c.
#[derive(Debug, Clone)]
pub struct Coefficients {
    /// Coefficients of X.
    pub beta: DMatrix<f64>,
    /// Coefficients of Z.
    pub alpha: DVector<f64>,
}

/// Errors with each fold left out.
#[derive(Debug, Clone)]
pub struct CrossValidated {
    /// Sum of squares of each block, by the model fitted without its fold.
    pub loss: Vec<f64>,
    /// Mean square of the rows kept, for each fold.
    pub train: Vec<f64>,
}

/// Value added to the diagonal of scaled normal equations, so that columns that the data do not distinguish stay small.
const JITTER: f64 = 1e-10;

/// Jitter for columns with one coefficient for all outputs.
const COUPLED_JITTER: f64 = 1e-6;

impl Grams {
    /// Returns the gram matrices of a design.
    pub fn new(design: &Design, blocks: &Blocks) -> Self {
        let rows = design.x.nrows().max(1) as f64;
        let rms = |norm: f64| (norm / rows).sqrt().max(f64::MIN_POSITIVE);
        let (p, c) = (design.x.ncols(), design.coupled.len());
        let own = DVector::from_iterator(p, design.x.column_iter().map(|x| rms(x.norm_squared())));
        let shared = DVector::from_iterator(c, design.coupled.iter().map(|z| rms(z.norm_squared())));
        let width = design.y.ncols();
        // The coupled columns, output by output.
        let mut z = DMatrix::zeros(design.x.nrows(), width * c);
        for (j, coupled) in design.coupled.iter().enumerate() {
            for (m, of_output) in coupled.column_iter().enumerate() {
                z.set_column(m * c + j, &(of_output / shared[j]));
            }
        }
        let of = |rows: &Range<usize>| Products::new(&design.x, &z, &design.y, rows).scaled(&own);
        let parts = blocks.rows.iter().map(of).collect();
        Self { parts, scale: (own, shared), shrunk: DVector::from_column_slice(&design.shrunk) }
    }

    fn sum(&self) -> Products {
        let mut sum = Products { rows: 0, ..self.parts[0].zeros() };
        self.parts.iter().for_each(|part| sum.add(part, 1.0));
        sum
    }

    /// Solves for β and α in scaled columns; none where the equations are singular.
    fn solve_scaled(&self, kept: &Products, ridge: f64) -> Option<Coefficients> {
        let mut g = kept.g.clone();
        let n = kept.rows as f64;
        (0..g.nrows()).for_each(|j| g[(j, j)] += (ridge * self.shrunk[j] + JITTER) * n);
        let c = kept.zz.nrows();
        if g.nrows() == 0 && c == 0 {
            return Some(Coefficients { beta: DMatrix::zeros(0, kept.h.ncols()), alpha: DVector::zeros(0) });
        }
        let factor = g.cholesky()?;
        let mut beta = factor.solve(&kept.h);
        if c == 0 {
            return Some(Coefficients { beta, alpha: DVector::zeros(0) });
        }
        let through = factor.solve(&kept.b);
        let mut s = kept.zz.clone();
        (0..c).for_each(|j| s[(j, j)] += COUPLED_JITTER * n);
        let mut along = kept.zy.clone();
        for m in 0..beta.ncols() {
            let w = through.columns(m * c, c);
            s -= kept.b.columns(m * c, c).tr_mul(&w);
            along -= w.tr_mul(&kept.h.column(m));
        }
        let alpha = s.cholesky()?.solve(&along);
        for (m, mut own) in beta.column_iter_mut().enumerate() {
            own.gemv(-1.0, &through.columns(m * c, c), &alpha, 1.0);
        }
        Some(Coefficients { beta, alpha })
    }

    fn unscaled(&self, mut solved: Coefficients) -> Coefficients {
        solved.beta.row_iter_mut().zip(self.scale.0.iter()).for_each(|(mut row, scale)| row /= *scale);
        solved.alpha.row_iter_mut().zip(self.scale.1.iter()).for_each(|(mut row, scale)| row /= *scale);
        solved
    }

    /// Returns the coefficients of all rows, in the units of the design; none where the equations are singular.
    pub fn solve(&self, ridge: f64) -> Option<Coefficients> {
        let solved = self.unscaled(self.solve_scaled(&self.sum(), ridge)?);
        solved.beta.iter().chain(solved.alpha.iter()).all(|b| b.is_finite()).then_some(solved)
    }

    /// Returns the coefficients without each fold, in the units of the design.
    pub fn solve_folds(&self, blocks: &Blocks, ridge: f64) -> Option<Vec<Coefficients>> {
        let sum = self.sum();
        (0..blocks.folds)
            .map(|fold| Some(self.unscaled(self.solve_scaled(&self.without(&sum, blocks, fold), ridge)?)))
            .collect()
    }

    fn without(&self, sum: &Products, blocks: &Blocks, fold: usize) -> Products {
        let mut kept = sum.clone();
        (0..blocks.len()).filter(|&b| blocks.fold[b] == fold).for_each(|b| kept.add(&self.parts[b], -1.0));
        kept
    }

    /// Leaves each fold out in turn, and returns the errors on it.
    pub fn cross_validate(&self, blocks: &Blocks, ridge: f64) -> Option<CrossValidated> {
        let sum = self.sum();
        let (mut loss, mut train) = (vec![0.0; blocks.len()], vec![0.0; blocks.folds]);
        for (fold, train) in train.iter_mut().enumerate() {
            let kept = self.without(&sum, blocks, fold);
            let solved = self.solve_scaled(&kept, ridge)?;
            *train = kept.loss(&solved) / kept.rows.max(1) as f64;
            let left_out = (0..blocks.len()).filter(|&b| blocks.fold[b] == fold);
            left_out.for_each(|b| loss[b] = self.parts[b].loss(&solved));
        }
        loss.iter().all(|loss| loss.is_finite()).then_some(CrossValidated { loss, train })
    }
}

/// Returns y − X β with β fitted without each row's fold, N × M; none where the equations are singular.
pub fn left_out(design: &Design, blocks: &Blocks, ridge: f64) -> Option<DMatrix<f64>> {
    let solved = Grams::new(design, blocks).solve_folds(blocks, ridge)?;
    let mut residual = design.y.clone();
    for (rows, fold) in blocks.rows.iter().zip(&blocks.fold) {
        let predicted = design.x.rows(rows.start, rows.len()) * &solved[*fold].beta;
        let mut part = residual.rows_mut(rows.start, rows.len());
        part -= predicted;
    }
    Some(residual)
}

impl Products {
    fn new(x: &DMatrix<f64>, z: &DMatrix<f64>, y: &DMatrix<f64>, rows: &Range<usize>) -> Self {
        let c = z.ncols() / y.ncols().max(1);
        let (mut zz, mut zy) = (DMatrix::zeros(c, c), DVector::zeros(c));
        for (m, y) in y.column_iter().enumerate() {
            let z = z.view((rows.start, m * c), (rows.len(), c));
            zz += z.tr_mul(&z);
            zy += z.tr_mul(&y.rows(rows.start, rows.len()));
        }
        let yy = y.column_iter().map(|y| y.rows(rows.start, rows.len()).norm_squared());
        Self {
            g: product(x, x, rows.clone()),
            h: product(x, y, rows.clone()),
            yy: DVector::from_iterator(y.ncols(), yy),
            b: product(x, z, rows.clone()),
            zz,
            zy,
            rows: rows.len(),
        }
    }

    /// Returns the products for columns of X divided by `scale`.
    fn scaled(mut self, scale: &DVector<f64>) -> Self {
        self.g.column_iter_mut().zip(scale.iter()).for_each(|(mut column, scale)| column /= *scale);
        for x in [&mut self.g, &mut self.h, &mut self.b] {
            x.column_iter_mut().for_each(|mut column| column.component_div_assign(scale));
        }
        self
    }

    fn zeros(&self) -> Self {
        let zero = |m: &DMatrix<f64>| DMatrix::zeros(m.nrows(), m.ncols());
        Self {
            g: zero(&self.g),
            h: zero(&self.h),
            yy: DVector::zeros(self.yy.len()),
            b: zero(&self.b),
            zz: zero(&self.zz),
            zy: DVector::zeros(self.zy.len()),
            rows: 0,
        }
    }

    /// Adds or subtracts another.
    fn add(&mut self, other: &Self, sign: f64) {
        let into = |own: &mut DMatrix<f64>, other: &DMatrix<f64>| {
            own.as_mut_slice().iter_mut().zip(other.as_slice()).for_each(|(own, other)| *own += sign * other);
        };
        into(&mut self.g, &other.g);
        into(&mut self.h, &other.h);
        self.yy.axpy(sign, &other.yy, 1.0);
        into(&mut self.b, &other.b);
        into(&mut self.zz, &other.zz);
        self.zy.axpy(sign, &other.zy, 1.0);
        if sign > 0.0 { self.rows += other.rows } else { self.rows -= other.rows }
    }

    /// Returns the sum of squares.
    fn loss(&self, solved: &Coefficients) -> f64 {
        let (beta, alpha) = (&solved.beta, &solved.alpha);
        let mut loss = self.yy.sum() - 2.0 * beta.dot(&self.h) + beta.dot(&(&self.g * beta));
        if !alpha.is_empty() {
            let c = alpha.len();
            for (m, beta) in beta.column_iter().enumerate() {
                loss += 2.0 * beta.dot(&(self.b.columns(m * c, c) * alpha));
            }
            loss += alpha.dot(&(&self.zz * alpha)) - 2.0 * alpha.dot(&self.zy);
        }
        loss.max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planted() -> (Design, Blocks) {
        let x = DMatrix::from_fn(60, 3, |k, j| ((k * (j + 1)) as f64 * 0.31).sin() + if j == 0 { 1.0 } else { 0.0 });
        let z = DMatrix::from_fn(60, 2, |k, m| ((k + 7 * m) as f64 * 0.17).cos());
        let y = DMatrix::from_fn(60, 2, |k, m| {
            0.7 * x[(k, 0)] - (m as f64 + 0.2) * x[(k, 1)] + 1.5 * z[(k, m)] + 0.1 * ((k * k + m) as f64).sin()
        });
        let design = Design { x, coupled: vec![z], y, shrunk: vec![0.0; 3], correction: 3 };
        (design, Blocks::new(&[15, 15, 15, 15]))
    }

    /// Oracle: least squares of all outputs below one another, without the rows of a fold, by the normal equations written out.
    #[test]
    fn a_fold_left_out_is_a_refit_without_it() {
        let (design, blocks) = planted();
        let cv = Grams::new(&design, &blocks).cross_validate(&blocks, 0.0).unwrap();
        for (b, rows) in blocks.rows.iter().enumerate() {
            let kept: Vec<usize> = (0..60)
                .filter(|k| {
                    blocks.rows.iter().position(|r| r.contains(k)).is_none_or(|r| blocks.fold[r] != blocks.fold[b])
                })
                .collect();
            let stacked = |k: usize, m: usize| -> Vec<f64> {
                let mut row = vec![0.0; 7];
                (0..3).for_each(|j| row[3 * m + j] = design.x[(k, j)]);
                row[6] = design.coupled[0][(k, m)];
                row
            };
            let all: Vec<(Vec<f64>, f64)> = kept
                .iter()
                .flat_map(|&k| (0..2).map(move |m| (k, m)))
                .map(|(k, m)| (stacked(k, m), design.y[(k, m)]))
                .collect();
            let a = DMatrix::from_fn(all.len(), 7, |r, j| all[r].0[j]);
            let t = DVector::from_fn(all.len(), |r, _| all[r].1);
            let solution = a.clone().svd(true, true).solve(&t, 1e-12).unwrap();
            let loss: f64 = rows
                .clone()
                .flat_map(|k| (0..2).map(move |m| (k, m)))
                .map(|(k, m)| (design.y[(k, m)] - DVector::from_vec(stacked(k, m)).dot(&solution)).powi(2))
                .sum();
            assert!((cv.loss[b] - loss).abs() < 1e-4 * (1.0 + loss), "{} and {loss}", cv.loss[b]);
        }
    }
}
