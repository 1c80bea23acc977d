//! Actuation map: from actuator coordinates to strain amplitudes.
//!
//! ```text
//! A_k = Φ_k(q) = Σ_j φ_{k,j} m_j(q),   m_j(q) = Π_a q_a^{e_{j,a}},   1 ≤ Σ_a e_{j,a} ≤ degree
//! ```
//!
//! | symbol | meaning                                | shape | unit                      |
//! | `q`    | actuator coordinates                   | A     | SI (rad, m, Pa, …)        |
//! | `m`    | monomials, without the constant        | M     | unit of q to its degree   |
//! | `φ`    | coefficients                           | K × M | rad/m per unit of m       |
//!
//! No constant term: the arm is straight where all actuators are at zero.
//! Two actuators at degree three have nine monomials: q1, q2, q1², q1 q2, q2², q1³, q1² q2, q1 q2², q2³.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use crate::kinematics::real::Real;

/// Largest degree that is accepted.
pub const LARGEST_DEGREE: usize = 9;

/// The monomials of `actuators` variables up to a degree, lower degrees first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Monomials {
    exponents: Vec<Vec<usize>>,
    /// m_j = q_a · m_before, or q_a alone.
    factors: Vec<(usize, Option<usize>)>,
    /// ∂m_j/∂q_a = exponent · m_before, or the exponent alone: entry j·A + a.
    slopes: Vec<(usize, Option<usize>)>,
    degree: usize,
    actuators: usize,
}

/// All monomials of degrees 1 to `degree`; none where either is zero.
pub fn monomials(actuators: usize, degree: usize) -> Monomials {
    monomials_within(&vec![degree; actuators], degree)
}

/// The monomials of degrees 1 to `degree` in which no actuator has a higher power than its own `highest`.
pub fn monomials_within(highest: &[usize], degree: usize) -> Monomials {
    let actuators = highest.len();
    let exponents: Vec<Vec<usize>> = (1..=degree).flat_map(|total| exponents_of_degree(highest, total)).collect();
    // Where the monomial stands that has one q_a less; the constant has no place.
    let places: BTreeMap<&[usize], usize> = exponents.iter().enumerate().map(|(j, e)| (e.as_slice(), j)).collect();
    let without = |exponents: &[usize], a: usize| {
        let mut fewer = exponents.to_vec();
        fewer[a] -= 1;
        places.get(fewer.as_slice()).copied()
    };
    let mut factors = Vec::with_capacity(exponents.len());
    let mut slopes = Vec::with_capacity(exponents.len() * actuators);
    for exponents in &exponents {
        let last = exponents.iter().rposition(|&e| e > 0).unwrap_or(0);
        factors.push((last, without(exponents, last)));
        let of = |(a, &e): (usize, &usize)| (e, if e > 0 { without(exponents, a) } else { None });
        slopes.extend(exponents.iter().enumerate().map(of));
    }
    drop(places);
    Monomials { exponents, factors, slopes, degree, actuators }
}

/// Number of monomials of degrees 1 to `degree` without listing them: C(actuators + degree, degree) − 1.
pub fn monomial_count(actuators: usize, degree: usize) -> usize {
    monomial_count_within(&vec![degree; actuators], degree)
}

/// Number of those of [`monomials_within`], without listing them; 2⁶⁰ where there are more.
pub fn monomial_count_within(highest: &[usize], degree: usize) -> usize {
    let mut of_degree = vec![0_usize; degree + 1];
    of_degree[0] = 1;
    for &highest in highest {
        of_degree = (0..=degree)
            .map(|total| (0..=highest.min(total)).fold(0_usize, |sum, e| sum.saturating_add(of_degree[total - e])))
            .collect();
    }
    of_degree[1..].iter().fold(0_usize, |sum, count| sum.saturating_add(*count)).min(1 << 60)
}

/// Exponents up to their highest that sum to `total`, the first variable's highest power first.
fn exponents_of_degree(highest: &[usize], total: usize) -> Vec<Vec<usize>> {
    match highest {
        [] => Vec::new(),
        [last] => (total <= *last).then(|| vec![total]).into_iter().collect(),
        [first, rest @ ..] => (0..=total.min(*first))
            .rev()
            .flat_map(|first| {
                let rest = exponents_of_degree(rest, total - first);
                rest.into_iter().map(move |rest| [vec![first], rest].concat())
            })
            .collect(),
    }
}

impl Monomials {
    /// Number of monomials.
    pub fn len(&self) -> usize {
        self.exponents.len()
    }

    /// True where degree or number of actuators is zero.
    pub fn is_empty(&self) -> bool {
        self.exponents.is_empty()
    }

    /// Highest degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Exponents of each monomial, one per actuator.
    pub fn exponents(&self) -> &[Vec<usize>] {
        &self.exponents
    }

    /// Values at `q` (one entry per actuator) into `out` (one per monomial).
    ///
    /// # Panics
    /// If there is not one value for each actuator, or not room for each monomial.
    pub fn evaluate(&self, q: &[f64], out: &mut [f64]) {
        assert_eq!(q.len(), self.actuators, "one value per actuator");
        self.values(q, out);
    }

    /// Design of a polynomial, N × (1 + M): 1 and the monomials at each row of `q`, N × A.
    ///
    /// # Panics
    /// If there is not one column for each actuator.
    pub fn design(&self, q: &DMatrix<f64>) -> DMatrix<f64> {
        assert_eq!(q.ncols(), self.actuators, "one column per actuator");
        let mut design = DMatrix::from_element(q.nrows(), 1 + self.len(), 1.0);
        // A column at a time: each is an earlier one times an actuator.
        for (j, &(a, before)) in self.factors.iter().enumerate() {
            let (done, mut rest) = design.columns_range_pair_mut(..j + 1, j + 1..);
            let before = done.column(before.map_or(0, |before| 1 + before));
            rest.column_mut(0).zip_zip_apply(&before, &q.column(a), |own, before, q| *own = before * q);
        }
        design
    }

    /// Slopes `∂m_j/∂q_a` at `q` into `out[j·A + a]`; `values` are those of [`Monomials::evaluate`].
    pub fn gradient(&self, values: &[f64], out: &mut [f64]) {
        for (out, &(exponent, before)) in out.iter_mut().zip(&self.slopes) {
            *out = before.map_or(exponent as f64, |before| exponent as f64 * values[before]);
        }
    }

    /// [`Monomials::evaluate`] for one sample or several: each monomial is an earlier one times an actuator.
    #[inline(always)]
    pub(crate) fn values<T: Real>(&self, q: &[T], out: &mut [T]) {
        for (j, &(a, before)) in self.factors.iter().enumerate() {
            out[j] = match before {
                Some(before) => out[before] * q[a],
                None => q[a],
            };
        }
    }

    /// `Σ_j c_j ∂m_j/∂q_a` for coefficients `c`, from the values of the monomials.
    #[inline(always)]
    pub(crate) fn slope<T: Real>(&self, c: &[f64], values: &[T], a: usize) -> T {
        let mut sum = values[0].like(0.0);
        for (c, slopes) in c.iter().zip(self.slopes.chunks_exact(self.actuators)) {
            let (exponent, before) = slopes[a];
            let weight = c * exponent as f64;
            sum = match before {
                Some(before) => sum + values[before] * weight,
                None => sum + weight,
            };
        }
        sum
    }

    /// Name such as `q1^2*q2`.
    pub fn name(&self, monomial: usize) -> String {
        let factors = self.exponents[monomial].iter().enumerate();
        let named = factors.filter(|(_, e)| **e > 0).map(|(a, e)| match e {
            1 => format!("q{}", a + 1),
            e => format!("q{}^{e}", a + 1),
        });
        named.collect::<Vec<_>>().join("*")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_actuators_at_degree_three_have_the_papers_nine() {
        let list = monomials(2, 3);
        let names: Vec<String> = (0..list.len()).map(|j| list.name(j)).collect();
        let expected = "q1 q2 q1^2 q1*q2 q2^2 q1^3 q1^2*q2 q1*q2^2 q2^3";
        assert_eq!(names.join(" "), expected);
    }

    /// Oracle: hand arithmetic at q = (2, −3).
    #[test]
    fn values_by_hand() {
        let list = monomials(2, 3);
        let mut out = [0.0; 9];
        list.evaluate(&[2.0, -3.0], &mut out);
        assert_eq!(out, [2.0, -3.0, 4.0, -6.0, 9.0, 8.0, -12.0, 18.0, -27.0]);
    }

    /// Oracle: powers.
    #[test]
    fn a_design_has_products_of_powers() {
        let (list, q) = (monomials(2, 4), DMatrix::from_row_slice(3, 2, &[2.0, -3.0, -0.5, 0.25, 1.5, 0.75]));
        let design = list.design(&q);
        for n in 0..3 {
            assert_eq!(design[(n, 0)], 1.0);
            for (j, exponents) in list.exponents().iter().enumerate() {
                let truth = q[(n, 0)].powi(exponents[0] as i32) * q[(n, 1)].powi(exponents[1] as i32);
                assert!((design[(n, 1 + j)] - truth).abs() < 1e-12, "{} at {n}", list.name(j));
            }
        }
        assert_eq!(monomials(2, 0).design(&q), DMatrix::from_element(3, 1, 1.0));
    }

    /// Oracle: the list, and binomial coefficients by hand.
    #[test]
    fn the_count_needs_no_list() {
        assert_eq!([(2, 3), (3, 4), (2, 7)].map(|(actuators, degree)| monomial_count(actuators, degree)), [9, 34, 35]);
        for actuators in 1..6 {
            for degree in 1..5 {
                let listed = monomials(actuators, degree).len();
                assert_eq!(listed, monomial_count(actuators, degree));
            }
        }
        assert_eq!([monomial_count(10_000, 9), monomial_count(2, 0), monomial_count(0, 3)], [1 << 60, 0, 0]);
    }

    /// Oracle: a list by hand; and the whole list, without what has too high a power.
    #[test]
    fn powers_within_their_highest_are_those_of_the_whole_list() {
        let list = monomials_within(&[3, 1], 3);
        let names: Vec<String> = (0..list.len()).map(|j| list.name(j)).collect();
        assert_eq!(names.join(" "), "q1 q2 q1^2 q1*q2 q1^3 q1^2*q2");
        for (highest, degree) in [(vec![6, 2], 6), (vec![1, 1, 1], 3), (vec![4, 0, 2], 4), (vec![2], 5)] {
            let whole = monomials(highest.len(), degree);
            let within = |exponents: &&Vec<usize>| exponents.iter().zip(&highest).all(|(e, highest)| e <= highest);
            let expected: Vec<Vec<usize>> = whole.exponents().iter().filter(within).cloned().collect();
            assert_eq!(monomials_within(&highest, degree).exponents(), expected);
            assert_eq!(monomial_count_within(&highest, degree), expected.len());
        }
    }

    /// Oracle: central differences, exact to rounding for a cubic with a small step.
    #[test]
    fn gradient_is_the_derivative() {
        let list = monomials(3, 3);
        let q = [0.7, -1.3, 0.4];
        let (mut values, mut slopes) = (vec![0.0; list.len()], vec![0.0; list.len() * 3]);
        list.evaluate(&q, &mut values);
        list.gradient(&values, &mut slopes);
        for a in 0..3 {
            let value = |shift: f64| {
                let mut moved = q;
                moved[a] += shift;
                let mut out = vec![0.0; list.len()];
                list.evaluate(&moved, &mut out);
                out
            };
            let (after, before) = (value(1e-5), value(-1e-5));
            for j in 0..list.len() {
                let slope = (after[j] - before[j]) / 2e-5;
                assert!((slopes[3 * j + a] - slope).abs() < 1e-8);
            }
        }
    }
}
