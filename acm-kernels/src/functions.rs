//! Elementwise functions on vectors, and their slopes.
//!
//! ```text
//! tanh x = x P(x²)/Q(x²)          on |x| ≤ 8, held constant beyond
//! σ(x)   = ½ + ½ tanh(x/2)
//! erf x  = x P(x²)/Q(x²)          on |x| ≤ 3.9, held constant beyond
//! exp x  = 2ⁿ p(f),   x = (n + f) ln 2,  |f| ≤ ½
//! ```
//!
//! Both rational functions were fitted to the smallest greatest relative error (Lawson's reweighted least
//! squares on 6000 Chebyshev nodes): 6e-9 for tanh with degrees (4,4), 2e-8 for erf with (5,5), so that what
//! is left is rounding. A common factor of numerator and denominator was chosen for the least rounding. The
//! tests compare with double precision all over the axis: 3e-7 at most, and in proportion to |x| for
//! those functions that grow with it.

use pulp::Simd;

use crate::shape::Activation;

const TANH_TOP: [f32; 5] = [2.713_744_9e-8, 3.901_180_2e-5, 0.006_363_861, 0.239_553_69, 1.781_797_4];
const TANH_BOTTOM: [f32; 5] = [1.518_524_5e-6, 6.078_226_7e-4, 0.046_619_724, 0.833_486_1, 1.781_797_4];
const TANH_END: f32 = 8.0;

const ERF_TOP: [f32; 6] = [2.514_896_6e-6, 3.469_232e-4, 0.004_549_64, 0.064_097_43, 0.230_826_56, 1.373_241_4];
const ERF_BOTTOM: [f32; 6] = [4.657_473_6e-5, 0.001_408_545_6, 0.018_150_847, 0.138_518_65, 0.610_231_9, 1.217_003_5];
const ERF_END: f32 = 3.9;

/// Taylor's coefficients of 2^f, the highest first.
const EXP2: [f32; 8] =
    [1.525_273_4e-5, 1.540_353e-4, 0.001_333_355_8, 0.009_618_129, 0.055_504_11, 0.240_226_5, 0.693_147_2, 1.0];

/// Horner's rule, the highest coefficient first.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(s: S, x: S::f32s, coefficients: [f32; N]) -> S::f32s {
    let mut sum = s.splat_f32s(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        sum = s.mul_add_e_f32s(sum, x, s.splat_f32s(coefficient));
    }
    sum
}

/// x P(x²)/Q(x²) with x held within ±end.
#[inline(always)]
fn odd<S: Simd, const N: usize>(s: S, x: S::f32s, top: [f32; N], bottom: [f32; N], end: f32) -> S::f32s {
    let x = s.max_f32s(s.min_f32s(x, s.splat_f32s(end)), s.splat_f32s(-end));
    let square = s.mul_f32s(x, x);
    s.div_f32s(s.mul_f32s(x, polynomial(s, square, top)), polynomial(s, square, bottom))
}

/// tanh x.
#[inline(always)]
pub(crate) fn tanh<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    odd(s, x, TANH_TOP, TANH_BOTTOM, TANH_END)
}

/// 1/(1 + e⁻ˣ).
#[inline(always)]
pub(crate) fn sigmoid<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    let half = s.splat_f32s(0.5);
    s.mul_add_e_f32s(tanh(s, s.mul_f32s(half, x)), half, half)
}

/// eˣ, with x held within the exponents of normal numbers.
#[inline(always)]
pub(crate) fn exp<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    // Adding 1.5·2²³ leaves the nearest integer in the lowest bits of the sum.
    const SHIFT: f32 = 12_582_912.0;
    let x = s.max_f32s(s.min_f32s(x, s.splat_f32s(88.0)), s.splat_f32s(-87.0));
    let shifted = s.mul_add_e_f32s(x, s.splat_f32s(std::f32::consts::LOG2_E), s.splat_f32s(SHIFT));
    let n = s.sub_f32s(shifted, s.splat_f32s(SHIFT));
    // x − n ln 2 in two pieces, then in units of ln 2.
    let rest = s.mul_add_e_f32s(n, s.splat_f32s(-0.693_359_4), x);
    let rest = s.mul_add_e_f32s(n, s.splat_f32s(2.121_944_4e-4), rest);
    let fraction = s.mul_f32s(rest, s.splat_f32s(std::f32::consts::LOG2_E));
    let power = s.wrapping_dyn_shl_u32s(s.transmute_u32s_f32s(shifted), s.splat_u32s(23));
    s.transmute_f32s_u32s(s.add_u32s(s.transmute_u32s_f32s(polynomial(s, fraction, EXP2)), power))
}

/// Φ(x), the normal distribution.
#[inline(always)]
fn normal<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    let half = s.splat_f32s(0.5);
    let scaled = s.mul_f32s(x, s.splat_f32s(std::f32::consts::FRAC_1_SQRT_2));
    s.mul_add_e_f32s(odd(s, scaled, ERF_TOP, ERF_BOTTOM, ERF_END), half, half)
}

/// 1 − y².
#[inline(always)]
pub(crate) fn tanh_slope<S: Simd>(s: S, y: S::f32s) -> S::f32s {
    s.negate_mul_add_e_f32s(y, y, s.splat_f32s(1.0))
}

/// y(1 − y).
#[inline(always)]
pub(crate) fn sigmoid_slope<S: Simd>(s: S, y: S::f32s) -> S::f32s {
    s.negate_mul_add_e_f32s(y, y, y)
}

/// An activation known when the code is compiled, so that none is chosen inside a loop.
pub(crate) trait Curve {
    /// Value and slope at x.
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s);
}

/// 1.7159 tanh(0.666 x).
pub(crate) struct LecunTanh;
/// tanh x.
pub(crate) struct Tanh;
/// max(x, 0).
pub(crate) struct Relu;
/// x σ(x).
pub(crate) struct Silu;
/// x Φ(x).
pub(crate) struct Gelu;

impl Curve for LecunTanh {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let y = tanh(s, s.mul_f32s(s.splat_f32s(0.666), x));
        let slope = s.mul_f32s(s.splat_f32s(1.7159 * 0.666), tanh_slope(s, y));
        (s.mul_f32s(s.splat_f32s(1.7159), y), slope)
    }
}

impl Curve for Tanh {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let y = tanh(s, x);
        (y, tanh_slope(s, y))
    }
}

impl Curve for Relu {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let zero = s.splat_f32s(0.0);
        let positive = s.greater_than_f32s(x, zero);
        (s.select_f32s(positive, x, zero), s.select_f32s(positive, s.splat_f32s(1.0), zero))
    }
}

impl Curve for Silu {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let y = sigmoid(s, x);
        (s.mul_f32s(x, y), s.mul_add_e_f32s(x, sigmoid_slope(s, y), y))
    }
}

impl Curve for Gelu {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let y = normal(s, x);
        let square = s.mul_f32s(x, x);
        let bell = exp(s, s.mul_f32s(s.splat_f32s(-0.5), square));
        let density = s.mul_f32s(s.splat_f32s(0.398_942_3), bell);
        (s.mul_f32s(x, y), s.mul_add_e_f32s(x, density, y))
    }
}

/// A piece of work that needs an activation.
pub(crate) trait WithCurve {
    /// Does it.
    fn with<F: Curve>(self);
}

impl Activation {
    /// Does `work` with the copy of it that was compiled for this activation.
    #[inline(always)]
    pub(crate) fn choose(self, work: impl WithCurve) {
        match self {
            Self::LecunTanh => work.with::<LecunTanh>(),
            Self::Tanh => work.with::<Tanh>(),
            Self::Relu => work.with::<Relu>(),
            Self::Silu => work.with::<Silu>(),
            Self::Gelu => work.with::<Gelu>(),
        }
    }
}
