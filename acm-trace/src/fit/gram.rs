//! Products of a design, block by block, so that a refit without a fold is a sum and one solution.
//!
//! ```text
//! A = Σ_{b∉f} XᵀX + λ n_f D,   B_m = Σ XᵀZ_m,   S = Σ_m (Σ Z_mᵀZ_m − B_mᵀA⁻¹B_m)
//! α = S⁻¹ Σ_m (Σ Z_mᵀy_m − B_mᵀA⁻¹ Σ Xᵀy_m),   β_m = A⁻¹(Σ Xᵀy_m − B_m α)
//! loss_b = Σ_m ‖y_m − X β_m − Z_m α‖² over the rows of b ∈ f
//! ```
//!
//! Columns are scaled to unit mean square first, so that λ has no unit.

use nalgebra::{DMatrix, DVector};

use super::blocks::Blocks;
use super::design::Design;
use crate::tall::product;

/// Products of one design with one or more sets of targets, M columns each.
#[derive(Debug, Clone)]
pub struct Grams {
    /// Of each block.
    parts: Vec<Products>,
    /// Root mean square of each column of X, and of each Z.
    scale: (DVector<f64>, DVector<f64>),
    /// Which columns the ridge shrinks, 1 or 0.
    shrunk: DVector<f64>,
    /// Outputs M.
    width: usize,
}

/// Products over some rows.
#[derive(Debug, Clone)]
struct Products {
    /// XᵀX, p × p.
    g: DMatrix<f64>,
    /// XᵀY, p × M·sets.
    h: DMatrix<f64>,
    /// ‖y‖² of each column.
    yy: DVector<f64>,
    /// XᵀZ_m of each output, p × c.
    b: Vec<DMatrix<f64>>,
    /// Σ_m Z_mᵀZ_m, c × c.
    zz: DMatrix<f64>,
    /// Z_mᵀy, c × M·sets.
    zy: DMatrix<f64>,
    rows: usize,
}

/// Coefficients: β p × M·sets, α c × sets.
#[derive(Debug, Clone)]
pub struct Coefficients {
    /// Of X.
    pub beta: DMatrix<f64>,
    /// Of Z.
    pub alpha: DMatrix<f64>,
}

/// Errors with each fold left out.
#[derive(Debug, Clone)]
pub struct CrossValidated {
    /// Sum of squares of each block, by the model fitted without its fold: `[set][block]`.
    pub loss: Vec<Vec<f64>>,
    /// Mean square of the rows kept, for each fold: `[set][fold]`.
    pub train: Vec<Vec<f64>>,
}

/// Added to the diagonal of scaled normal equations, so that columns that the data do not tell apart stay small.
const JITTER: f64 = 1e-10;

/// The same for columns with one coefficient for all outputs.
const COUPLED_JITTER: f64 = 1e-6;

impl Grams {
    /// Of a design with targets `y`, M columns for each of one or more sets.
    pub fn new(design: &Design, y: &DMatrix<f64>, blocks: &Blocks) -> Self {
        let rows = design.x.nrows().max(1) as f64;
        let rms = |norm: f64| (norm / rows).sqrt().max(f64::MIN_POSITIVE);
        let (p, c) = (design.x.ncols(), design.coupled.len());
        let own = DVector::from_iterator(p, design.x.column_iter().map(|x| rms(x.norm_squared())));
        let shared = DVector::from_iterator(c, design.coupled.iter().map(|z| rms(z.norm_squared())));
        let mut x = design.x.clone();
        x.column_iter_mut().zip(own.iter()).for_each(|(mut x, scale)| x /= *scale);
        let width = design.y.ncols();
        // Z_m: the coupled columns of one output beside one another.
        let z: Vec<DMatrix<f64>> = (0..width)
            .map(|m| DMatrix::from_fn(design.x.nrows(), c, |k, j| design.coupled[j][(k, m)] / shared[j]))
            .collect();
        let parts = blocks.rows.iter().map(|rows| Products::new(&x, &z, y, rows.clone())).collect();
        Self { parts, scale: (own, shared), shrunk: DVector::from_column_slice(&design.shrunk), width }
    }

    fn sum(&self) -> Products {
        let mut sum = Products { rows: 0, ..self.parts[0].zeros() };
        self.parts.iter().for_each(|part| sum.add(part, 1.0));
        sum
    }

    /// β and α in scaled columns; none where the equations are singular.
    fn solve_scaled(&self, kept: &Products, ridge: f64) -> Option<Coefficients> {
        let mut g = kept.g.clone();
        let n = kept.rows as f64;
        (0..g.nrows()).for_each(|j| g[(j, j)] += (ridge * self.shrunk[j] + JITTER) * n);
        let c = kept.zz.nrows();
        let sets = kept.h.ncols() / self.width.max(1);
        if g.nrows() == 0 && c == 0 {
            return Some(Coefficients { beta: DMatrix::zeros(0, kept.h.ncols()), alpha: DMatrix::zeros(0, sets) });
        }
        let factor = g.cholesky()?;
        let mut beta = factor.solve(&kept.h);
        let mut alpha = DMatrix::zeros(c, sets);
        if c > 0 {
            let through: Vec<DMatrix<f64>> = kept.b.iter().map(|b| factor.solve(b)).collect();
            let mut s = kept.zz.clone();
            (0..c).for_each(|j| s[(j, j)] += COUPLED_JITTER * n);
            kept.b.iter().zip(&through).for_each(|(b, w)| s -= b.tr_mul(w));
            for set in 0..sets {
                for m in 0..self.width {
                    let column = set * self.width + m;
                    let own = kept.zy.column(column) - through[m].tr_mul(&kept.h.column(column));
                    let mut sum = alpha.column_mut(set);
                    sum += own;
                }
            }
            alpha = s.cholesky()?.solve(&alpha);
            for set in 0..sets {
                for m in 0..self.width {
                    let moved = &through[m] * alpha.column(set);
                    let mut own = beta.column_mut(set * self.width + m);
                    own -= moved;
                }
            }
        }
        Some(Coefficients { beta, alpha })
    }

    fn unscaled(&self, mut solved: Coefficients) -> Coefficients {
        solved.beta.row_iter_mut().zip(self.scale.0.iter()).for_each(|(mut row, scale)| row /= *scale);
        solved.alpha.row_iter_mut().zip(self.scale.1.iter()).for_each(|(mut row, scale)| row /= *scale);
        solved
    }

    /// Coefficients of all rows, in the units of the design; none where the equations are singular.
    pub fn solve(&self, ridge: f64) -> Option<Coefficients> {
        let solved = self.unscaled(self.solve_scaled(&self.sum(), ridge)?);
        solved.beta.iter().chain(solved.alpha.iter()).all(|b| b.is_finite()).then_some(solved)
    }

    /// Coefficients without each fold, in the units of the design.
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

    /// Leaves each fold out in turn; targets are `sets` sets of equal width.
    pub fn cross_validate(&self, blocks: &Blocks, ridge: f64, sets: usize) -> Option<CrossValidated> {
        let sum = self.sum();
        let mut loss = vec![vec![0.0; blocks.len()]; sets];
        let mut train = vec![vec![0.0; blocks.folds]; sets];
        for fold in 0..blocks.folds {
            let kept = self.without(&sum, blocks, fold);
            let solved = self.solve_scaled(&kept, ridge)?;
            for (set, loss) in kept.losses(&solved, self.width).into_iter().enumerate() {
                train[set][fold] = loss / kept.rows.max(1) as f64;
            }
            for b in (0..blocks.len()).filter(|&b| blocks.fold[b] == fold) {
                for (set, own) in self.parts[b].losses(&solved, self.width).into_iter().enumerate() {
                    loss[set][b] = own;
                }
            }
        }
        loss.iter().flatten().all(|loss| loss.is_finite()).then_some(CrossValidated { loss, train })
    }
}

impl Products {
    fn new(x: &DMatrix<f64>, z: &[DMatrix<f64>], y: &DMatrix<f64>, rows: std::ops::Range<usize>) -> Self {
        let part = |m: &DMatrix<f64>| m.rows(rows.start, rows.len()).into_owned();
        let (c, width) = (z.first().map_or(0, DMatrix::ncols), z.len().max(1));
        let mut zy = DMatrix::zeros(c, y.ncols());
        let mut zz = DMatrix::zeros(c, c);
        let mut b = vec![];
        if c > 0 {
            let z: Vec<DMatrix<f64>> = z.iter().map(part).collect();
            let own = part(x);
            for one in &z {
                zz += one.tr_mul(one);
                b.push(own.tr_mul(one));
            }
            for k in 0..y.ncols() {
                let target = y.column(k).rows(rows.start, rows.len()).into_owned();
                zy.column_mut(k).copy_from(&z[k % width].tr_mul(&target));
            }
        }
        let yy = y.column_iter().map(|y| y.rows(rows.start, rows.len()).norm_squared());
        Self {
            g: product(x, x, rows.clone()),
            h: product(x, y, rows.clone()),
            yy: DVector::from_iterator(y.ncols(), yy),
            b,
            zz,
            zy,
            rows: rows.len(),
        }
    }

    fn zeros(&self) -> Self {
        let zero = |m: &DMatrix<f64>| DMatrix::zeros(m.nrows(), m.ncols());
        Self {
            g: zero(&self.g),
            h: zero(&self.h),
            yy: DVector::zeros(self.yy.len()),
            b: self.b.iter().map(zero).collect(),
            zz: zero(&self.zz),
            zy: zero(&self.zy),
            rows: 0,
        }
    }

    /// Adds another, or takes it away.
    fn add(&mut self, other: &Self, sign: f64) {
        let into = |own: &mut DMatrix<f64>, other: &DMatrix<f64>| {
            own.as_mut_slice().iter_mut().zip(other.as_slice()).for_each(|(own, other)| *own += sign * other);
        };
        into(&mut self.g, &other.g);
        into(&mut self.h, &other.h);
        self.yy.axpy(sign, &other.yy, 1.0);
        self.b.iter_mut().zip(&other.b).for_each(|(own, other)| into(own, other));
        into(&mut self.zz, &other.zz);
        into(&mut self.zy, &other.zy);
        if sign > 0.0 { self.rows += other.rows } else { self.rows -= other.rows }
    }

    /// Sum of squares of each set.
    fn losses(&self, solved: &Coefficients, width: usize) -> Vec<f64> {
        let sets = solved.alpha.ncols();
        let through = &self.g * &solved.beta;
        (0..sets)
            .map(|set| {
                let alpha = solved.alpha.column(set);
                let outputs: f64 = (0..width)
                    .map(|m| {
                        let k = set * width + m;
                        let beta = solved.beta.column(k);
                        let mut loss = self.yy[k] - 2.0 * beta.dot(&self.h.column(k)) + beta.dot(&through.column(k));
                        if let Some(b) = self.b.get(m) {
                            loss += 2.0 * beta.dot(&(b * alpha)) - 2.0 * alpha.dot(&self.zy.column(k));
                        }
                        loss
                    })
                    .sum();
                let shared = if alpha.is_empty() { 0.0 } else { alpha.dot(&(&self.zz * alpha)) };
                (outputs + shared).max(0.0)
            })
            .collect()
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
        let cv = Grams::new(&design, &design.y, &blocks).cross_validate(&blocks, 0.0, 1).unwrap();
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
            assert!((cv.loss[0][b] - loss).abs() < 1e-4 * (1.0 + loss), "{} and {loss}", cv.loss[0][b]);
        }
    }
}
