//! Columns of the correction: monomials, kinks and sums of angles of the normalised actuators.

use acm_core::actuation::Monomials;
use nalgebra::DMatrix;

use crate::fit::form::BEYOND;
use crate::fit::form::angles::sums;
use crate::fit::problem::Problem;
use crate::fit::state::State;

/// Basis functions of the correction.
pub struct Basis {
    monomials: Monomials,
    /// Actuator and place of each kink, the place in half ranges from the middle.
    kinks: Vec<(usize, f64)>,
    /// Multiples of each actuator in a sum of angles.
    sums: Vec<Vec<i8>>,
}

impl Basis {
    pub fn of(problem: &Problem, state: &State) -> Option<Self> {
        let actuators = problem.rig.actuators.len();
        let kinks = (0..actuators).flat_map(|a| state.form.kinks.places().map(move |place| (a, place))).collect();
        let sums = sums(problem.rig, state.form.sums);
        state.form.monomials(actuators).map(|monomials| Self { monomials, kinks, sums })
    }

    /// Returns the number of columns, with the constant.
    pub fn len(&self) -> usize {
        1 + self.monomials.len() + self.kinks.len() + 2 * self.sums.len()
    }
}

/// Joins two matrices side by side.
fn joined(x: DMatrix<f64>, more: &DMatrix<f64>) -> DMatrix<f64> {
    let first = x.ncols();
    if more.ncols() == 0 {
        return x;
    }
    let mut x = x.resize_horizontally(first + more.ncols(), 0.0);
    x.columns_mut(first, more.ncols()).copy_from(more);
    x
}

/// Returns the monomials and kinks of the normalised inputs, and the cosine and the sine of each sum of angles.
pub fn correction(problem: &Problem, basis: Option<&Basis>, q: &[f64], rows: usize) -> DMatrix<f64> {
    let Some(Basis { monomials, kinks, sums }) = basis else { return DMatrix::zeros(rows, 0) };
    let mut z = DMatrix::from_column_slice(rows, problem.range.len(), q);
    let turned = turned(&z, sums);
    for (mut z, (middle, half)) in z.column_iter_mut().zip(&problem.range) {
        z.apply(|z| *z = (*z - middle) / half);
    }
    if problem.base.is_some() {
        z.apply(|z| *z = z.clamp(-1.0, 1.0));
    }
    let bent: DMatrix<f64> = match kinks.len() {
        0 => DMatrix::zeros(rows, 0),
        count => DMatrix::from_fn(rows, count, |row, k| (z[(row, kinks[k].0)] - kinks[k].1).max(0.0)),
    };
    if problem.base.is_some() {
        return joined(joined(monomials.design(&z), &bent), &turned);
    }
    let straight = z.columns(0, monomials.len().min(z.ncols())).into_owned();
    z.apply(|z| *z = z.clamp(-BEYOND, BEYOND));
    let mut x = monomials.design(&z);
    x.columns_mut(1, straight.ncols()).copy_from(&straight);
    joined(joined(x, &bent), &turned)
}

/// Returns the cosine and the sine of each sum of the angles q.
fn turned(q: &DMatrix<f64>, sums: &[Vec<i8>]) -> DMatrix<f64> {
    let mut x = DMatrix::zeros(q.nrows(), 2 * sums.len());
    for (h, sum) in sums.iter().enumerate() {
        for row in 0..q.nrows() {
            let angle: f64 = sum.iter().zip(q.row(row).iter()).map(|(n, q)| f64::from(*n) * q).sum();
            (x[(row, 2 * h + 1)], x[(row, 2 * h)]) = angle.sin_cos();
        }
    }
    x
}
