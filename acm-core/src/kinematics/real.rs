//! Scalars and vectors of samples: the arithmetic of the arm's formulas.
//!
//! | `T`                          | stands for                                   |
//! | `f64`                        | one sample                                   |
//! | [`crate::kinematics::lanes::Lanes`]      | as many samples as a vector register holds   |
//!
//! Both carry out the same operations in the same order. Products are never fused with sums, so that one sample alone and
//! the same sample in company give the same bits, on every processor.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Arithmetic that the formulas need: scalars and vectors of samples.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// `value` in every place.
    fn like(self, value: f64) -> Self;

    /// The largest of the places.
    fn largest(self) -> f64;

    /// Functions of each place on its own: for what has no formula without branches.
    fn each<const N: usize>(self, of: impl Fn(f64) -> [f64; N]) -> [Self; N];
}

impl Real for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        self
    }

    #[inline(always)]
    fn each<const N: usize>(self, of: impl Fn(f64) -> [f64; N]) -> [Self; N] {
        of(self)
    }
}
