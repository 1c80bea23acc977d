//! Comparator: a polynomial from the actuators to the outputs.
//!
//! ```text
//! p = c_0 + Σ_j c_j m_j(q)
//! ```
//!
//! | symbol | meaning                                       | shape        | unit              |
//! | `m`    | monomials of [`crate::actuation`]             | M            | unit of q to its degree |
//! | `c`    | coefficients: constant first, one column per output | (1 + M) × O | unit of the output per unit of m |
//!
//! Solved by [`crate::fitting::linear`].

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::actuation::{Monomials, monomials};
use crate::fitting::linear;

/// A polynomial with its coefficients.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct Polynomial {
    monomials: Monomials,
    actuators: usize,
    coefficients: DMatrix<f64>,
}

/// Serialized form: one list of coefficients per output.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    degree: usize,
    actuators: usize,
    coefficients: Vec<Vec<f64>>,
}

/// A fitted polynomial and how well its coefficients are known.
#[derive(Debug, Clone)]
pub struct PolynomialFit {
    /// The polynomial.
    pub polynomial: Polynomial,
    /// Standard deviations, shaped as the coefficients; NaN where the data do not determine one.
    pub deviations: DMatrix<f64>,
}

impl Polynomial {
    /// Least squares fit to `outputs` [T×O] at `actuators` [T×A]; directions that the data do not
    /// determine get the smallest coefficients.
    pub fn fit(actuators: &DMatrix<f64>, outputs: &DMatrix<f64>, degree: usize) -> PolynomialFit {
        let monomials = monomials(actuators.ncols(), degree);
        let design = monomials.design(actuators);
        let solution = linear::solve(&design, outputs);
        let residual = outputs - design * &solution.coefficients;
        let freedom = outputs.nrows() as f64 - solution.coefficients.nrows() as f64;
        let deviations = DMatrix::from_fn(1 + monomials.len(), outputs.ncols(), |j, o| {
            (solution.variance[j] * residual.column(o).norm_squared() / freedom).sqrt()
        });
        let polynomial = Self { monomials, actuators: actuators.ncols(), coefficients: solution.coefficients };
        PolynomialFit { polynomial, deviations }
    }

    /// Coefficients, constant first: (1 + M) × O.
    pub fn coefficients(&self) -> &DMatrix<f64> {
        &self.coefficients
    }

    /// Number of actuators.
    pub fn actuators(&self) -> usize {
        self.actuators
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.coefficients.ncols()
    }

    /// The same polynomial with other coefficients, shaped alike.
    ///
    /// # Panics
    /// If they are not shaped alike.
    pub fn with_coefficients(mut self, coefficients: DMatrix<f64>) -> Self {
        assert_eq!(self.coefficients.shape(), coefficients.shape(), "one coefficient per monomial and output");
        self.coefficients = coefficients;
        self
    }

    /// The monomials beside the constant.
    pub fn monomials(&self) -> &Monomials {
        &self.monomials
    }

    /// Name of coefficient `row`: `1` for the constant.
    pub fn name(&self, row: usize) -> String {
        match row {
            0 => "1".into(),
            row => self.monomials.name(row - 1),
        }
    }

    /// Degree of the monomial of coefficient `row`.
    pub fn degree_of(&self, row: usize) -> usize {
        match row {
            0 => 0,
            row => self.monomials.exponents()[row - 1].iter().sum(),
        }
    }

    /// Outputs at `actuators` [T×A], as [T×O].
    pub fn predict(&self, actuators: &DMatrix<f64>) -> DMatrix<f64> {
        self.monomials.design(actuators) * &self.coefficients
    }
}

impl From<Polynomial> for Stored {
    fn from(polynomial: Polynomial) -> Self {
        let columns = polynomial.coefficients.column_iter();
        Self {
            degree: polynomial.monomials.degree(),
            actuators: polynomial.actuators,
            coefficients: columns.map(|c| c.iter().copied().collect()).collect(),
        }
    }
}

impl TryFrom<Stored> for Polynomial {
    type Error = String;

    fn try_from(stored: Stored) -> Result<Self, String> {
        let (degree, actuators) = (stored.degree, stored.actuators);
        if degree > crate::actuation::LARGEST_DEGREE {
            return Err(format!("stored polynomial has degree {degree}; calibrate again"));
        }
        let needed = 1 + crate::actuation::monomial_count(actuators, degree);
        if let Some(list) = stored.coefficients.iter().find(|list| list.len() != needed) {
            let found = list.len();
            return Err(format!(
                "stored polynomial has {found} coefficients per output where {needed} are needed; calibrate again"
            ));
        }
        let outputs = stored.coefficients.len();
        Ok(Self {
            monomials: monomials(actuators, degree),
            actuators,
            coefficients: DMatrix::from_fn(needed, outputs, |j, o| stored.coefficients[o][j]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(scale: f64) -> DMatrix<f64> {
        DMatrix::from_fn(60, 2, |t, a| scale * ((t * (a + 1)) as f64 * 0.7).sin())
    }

    /// Oracle: a planted cubic, at actuators of order one and of order 1e5 (pressures).
    #[test]
    fn a_planted_cubic_is_found() {
        for scale in [1.0, 1e5] {
            let q = inputs(scale);
            let truth = |t: usize| {
                let (a, b) = (q[(t, 0)] / scale, q[(t, 1)] / scale);
                [0.3 + 2.0 * a - b * b + 0.5 * a * a * b, a * b - 4.0 * b.powi(3)]
            };
            let y = DMatrix::from_fn(60, 2, |t, o| truth(t)[o]);
            let fit = Polynomial::fit(&q, &y, 3);
            assert!((fit.polynomial.predict(&q) - &y).amax() < 1e-12);
            let c = fit.polynomial.coefficients();
            assert!((c[(0, 0)] - 0.3).abs() < 1e-11);
            assert!((c[(9, 1)] * scale.powi(3) + 4.0).abs() < 1e-10);
        }
    }

    /// Oracle: the textbook formulas of a straight line.
    #[test]
    fn deviations_of_a_line_match_the_textbook() {
        let x: Vec<f64> = (0..20).map(|k| f64::from(k) * 0.5 - 3.0).collect();
        let y: Vec<f64> = x.iter().map(|x| 2.0 * x + 1.0 + (x * 5.0).sin()).collect();
        let fit = Polynomial::fit(&DMatrix::from_column_slice(20, 1, &x), &DMatrix::from_column_slice(20, 1, &y), 1);
        let mean = x.iter().sum::<f64>() / 20.0;
        let spread: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
        let slope = x.iter().zip(&y).map(|(x, y)| (x - mean) * y).sum::<f64>() / spread;
        let offset = y.iter().sum::<f64>() / 20.0 - slope * mean;
        let left = x.iter().zip(&y).map(|(x, y)| (y - offset - slope * x).powi(2)).sum::<f64>();
        let variance = left / 18.0;
        assert!((fit.polynomial.coefficients()[(1, 0)] - slope).abs() < 1e-12);
        assert!((fit.deviations[(1, 0)] - (variance / spread).sqrt()).abs() < 1e-12);
        let of_offset = (variance * (1.0 / 20.0 + mean * mean / spread)).sqrt();
        assert!((fit.deviations[(0, 0)] - of_offset).abs() < 1e-12);
    }

    #[test]
    fn an_actuator_that_never_moves_has_no_deviation() {
        let mut q = inputs(1.0);
        q.column_mut(1).fill(0.0);
        let y = DMatrix::from_fn(60, 1, |t, _| q[(t, 0)].powi(2) + 0.01 * (t as f64).sin());
        let fit = Polynomial::fit(&q, &y, 2);
        assert!(fit.deviations[(2, 0)].is_nan() && fit.deviations[(1, 0)].is_finite());
        assert!(fit.polynomial.coefficients()[(2, 0)].abs() < 1e-12);
    }

    #[test]
    fn stored_and_read_back_it_is_the_same_to_the_bit() {
        let q = inputs(1.0);
        let fit = Polynomial::fit(&q, &q.map(f64::exp), 3).polynomial;
        let text = serde_json::to_string(&fit).unwrap();
        assert_eq!(serde_json::from_str::<Polynomial>(&text).unwrap(), fit);
        assert!(serde_json::from_str::<Polynomial>(&text.replace("\"degree\":3", "\"degree\":2")).is_err());
    }
}
