//! Several samples in one vector register, as wide as the processor allows.
//!
//! | processor       | places |
//! | AVX-512         | 8      |
//! | AVX2            | 4      |
//! | NEON            | 2      |
//! | none of these   | 1      |
//!
//! [`pulp`] finds out at run time which one it is. Every place is computed as [`Real`] says, so the width changes no bit.

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

use crate::kinematics::real::Real;

/// The widest register.
const WIDEST: usize = 8;

/// Vector registers that load samples from memory and store results.
pub(crate) trait Register: Copy {
    /// The samples of one register.
    type Value: Real;

    /// How many they are; divides every block of samples.
    const PLACES: usize;

    /// The places from `from[0]` on.
    fn load(self, from: &[f64]) -> Self::Value;

    /// Into the places from `to[0]` on.
    fn store(self, value: Self::Value, to: &mut [f64]);
}

/// One sample at a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Single;

impl Register for Single {
    type Value = f64;

    const PLACES: usize = 1;

    #[inline(always)]
    fn load(self, from: &[f64]) -> f64 {
        from[0]
    }

    #[inline(always)]
    fn store(self, value: f64, to: &mut [f64]) {
        to[0] = value;
    }
}

/// A register of the processor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wide<S: Simd>(pub S);

impl<S: Simd> Register for Wide<S> {
    type Value = Lanes<S>;

    const PLACES: usize = S::F64_LANES;

    #[inline(always)]
    fn load(self, from: &[f64]) -> Lanes<S> {
        Lanes { simd: self.0, value: S::as_simd_f64s(&from[..S::F64_LANES]).0[0] }
    }

    #[inline(always)]
    fn store(self, value: Lanes<S>, to: &mut [f64]) {
        S::as_mut_simd_f64s(&mut to[..S::F64_LANES]).0[0] = value.value;
    }
}

/// The contents of a register.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    value: S::f64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    fn with(self, value: S::f64s) -> Self {
        Self { value, ..self }
    }
}

impl<S: Simd> Real for Lanes<S> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        self.with(self.simd.splat_f64s(value))
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.value)
    }

    #[inline(always)]
    fn each<const N: usize>(self, of: impl Fn(f64) -> [f64; N]) -> [Self; N] {
        let (mut places, mut results) = ([0.0; WIDEST], [[0.0; WIDEST]; N]);
        Wide(self.simd).store(self, &mut places);
        for k in 0..S::F64_LANES {
            for (result, value) in results.iter_mut().zip(of(places[k])) {
                result[k] = value;
            }
        }
        results.map(|result| Wide(self.simd).load(&result))
    }
}

impl<S: Simd> Add for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.simd.add_f64s(self.value, other.value))
    }
}

impl<S: Simd> Sub for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.simd.sub_f64s(self.value, other.value))
    }
}

impl<S: Simd> Mul for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(self.simd.mul_f64s(self.value, other.value))
    }
}

impl<S: Simd> Div for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(self.simd.div_f64s(self.value, other.value))
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self.simd.neg_f64s(self.value))
    }
}

impl<S: Simd> Add<f64> for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + self.like(other)
    }
}

impl<S: Simd> Mul<f64> for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * self.like(other)
    }
}
