//! Elementwise functions on vectors, and their slopes.
//!
//! ```text
//! tanh x = x P(x²)/Q(x²)          on |x| ≤ 8.1, held constant beyond
//! σ(x)   = ½ + ½ tanh(x/2)
//! Φ(−a)  = e^(−a²/2) t P(t),   t = 1/(1 + 0.3 a/√2),   Φ(a) = 1 − Φ(−a)      for a ≥ 0
//! exp x  = 2ⁿ p(f),   x = (n + f) ln 2,  |f| ≤ ½
//! ```
//!
//! P and Q were fitted to the smallest greatest relative error (Lawson's reweighted least squares on Chebyshev
//! nodes): 6e-9 for tanh with degrees (4,4), 2e-8 for the normal distribution's tail with degree 8, so that what
//! is left is rounding. A common factor of numerator and denominator was chosen for the least rounding. The
//! tests compare with double precision all over the axis.
//!
//! silu and gelu multiply with x, so their σ and Φ must vanish in proportion, where tanh's way to σ leaves 1e-7:
//! they go by exp.

use pulp::Simd;

use crate::shape::Activation;

const TANH_TOP: [f32; 5] = [2.993_908_8e-8, 4.334_371_3e-5, 0.007_097_504_6, 0.267_604_77, 1.991_354_3];
const TANH_BOTTOM: [f32; 5] = [1.681_968_5e-6, 6.768_381e-4, 0.052_046_936, 0.931_389_45, 1.991_354_3];
const TANH_END: f32 = 8.1;

/// Coefficients of P in the normal distribution's tail, the highest first, with the factor 1/2 in them.
const TAIL: [f32; 9] = [
    -0.064_761_4,
    0.242_781_35,
    -0.256_138_54,
    0.273_859_47,
    -0.047_325,
    0.107_462_885,
    0.074_169_62,
    0.085_357_605,
    0.084_594_005,
];

/// Taylor coefficients of 2^f, the highest first.
const EXP2: [f32; 8] =
    [1.525_273_4e-5, 1.540_353e-4, 0.001_333_355_8, 0.009_618_129, 0.055_504_11, 0.240_226_5, 0.693_147_2, 1.0];

/// Evaluates a polynomial by Horner's rule, the highest coefficient first.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(s: S, x: S::f32s, coefficients: [f32; N]) -> S::f32s {
    let mut sum = s.splat_f32s(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        sum = s.mul_add_e_f32s(sum, x, s.splat_f32s(coefficient));
    }
    sum
}

/// Clamps x to [low, high]. NaN stays NaN, so that a diverged network is noticed.
#[inline(always)]
fn held<S: Simd>(s: S, x: S::f32s, low: f32, high: f32) -> S::f32s {
    let (low, high) = (s.splat_f32s(low), s.splat_f32s(high));
    if S::IS_SCALAR {
        let x = s.select_f32s(s.greater_than_f32s(x, high), high, x);
        return s.select_f32s(s.less_than_f32s(x, low), low, x);
    }
    // Where one of two is no number, x86 takes the second and NEON neither.
    s.max_f32s(low, s.min_f32s(high, x))
}

/// Computes x P(x²)/Q(x²) with x clamped to ±end.
#[inline(always)]
fn odd<S: Simd, const N: usize>(s: S, x: S::f32s, top: [f32; N], bottom: [f32; N], end: f32) -> S::f32s {
    let x = held(s, x, -end, end);
    let square = s.mul_f32s(x, x);
    s.div_f32s(s.mul_f32s(x, polynomial(s, square, top)), polynomial(s, square, bottom))
}

/// Computes tanh x.
#[inline(always)]
pub(crate) fn tanh<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    odd(s, x, TANH_TOP, TANH_BOTTOM, TANH_END)
}

/// Computes 1/(1 + e⁻ˣ).
#[inline(always)]
pub(crate) fn sigmoid<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    let half = s.splat_f32s(0.5);
    s.mul_add_e_f32s(tanh(s, s.mul_f32s(half, x)), half, half)
}

/// Computes eˣ, with x clamped to the exponents of normal numbers.
#[inline(always)]
pub(crate) fn exp<S: Simd>(s: S, x: S::f32s) -> S::f32s {
    // Adding 1.5·2²³ leaves the nearest integer in the lowest bits of the sum.
    const SHIFT: f32 = 12_582_912.0;
    let x = held(s, x, -87.0, 88.0);
    let shifted = s.mul_add_e_f32s(x, s.splat_f32s(std::f32::consts::LOG2_E), s.splat_f32s(SHIFT));
    let n = s.sub_f32s(shifted, s.splat_f32s(SHIFT));
    // x − n ln 2 in two pieces, then in units of ln 2.
    let rest = s.mul_add_e_f32s(n, s.splat_f32s(-0.693_359_4), x);
    let rest = s.mul_add_e_f32s(n, s.splat_f32s(2.121_944_4e-4), rest);
    let fraction = s.mul_f32s(rest, s.splat_f32s(std::f32::consts::LOG2_E));
    let power = s.wrapping_dyn_shl_u32s(s.transmute_u32s_f32s(shifted), s.splat_u32s(23));
    s.transmute_f32s_u32s(s.add_u32s(s.transmute_u32s_f32s(polynomial(s, fraction, EXP2)), power))
}

/// Computes Φ(x), the normal distribution, and e^(−x²/2).
#[inline(always)]
fn normal<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
    let one = s.splat_f32s(1.0);
    let bell = exp(s, s.mul_f32s(s.splat_f32s(-0.5), s.mul_f32s(x, x)));
    let t = s.div_f32s(one, s.mul_add_e_f32s(s.splat_f32s(0.212_132_03), s.abs_f32s(x), one));
    let tail = s.mul_f32s(bell, s.mul_f32s(t, polynomial(s, t, TAIL)));
    let below = s.less_than_f32s(x, s.splat_f32s(0.0));
    (s.select_f32s(below, tail, s.sub_f32s(one, tail)), bell)
}

/// Computes σ(x) and σ(−x) = 1 − σ(x), both with a small relative error, as factors of x.
#[inline(always)]
fn vanishing_sigmoids<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
    let one = s.splat_f32s(1.0);
    let decay = exp(s, s.neg_f32s(x));
    let y = s.div_f32s(one, s.add_f32s(one, decay));
    (y, s.mul_f32s(decay, y))
}

/// Computes the slope 1 − y².
#[inline(always)]
pub(crate) fn tanh_slope<S: Simd>(s: S, y: S::f32s) -> S::f32s {
    s.negate_mul_add_e_f32s(y, y, s.splat_f32s(1.0))
}

/// Computes the slope y(1 − y).
#[inline(always)]
pub(crate) fn sigmoid_slope<S: Simd>(s: S, y: S::f32s) -> S::f32s {
    s.negate_mul_add_e_f32s(y, y, y)
}

/// An activation known when the code is compiled, so that none is chosen inside a loop.
pub(crate) trait Curve {
    /// Returns the value and slope at x.
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s);
}

/// Curve 1.7159 tanh(0.666 x).
pub(crate) struct LecunTanh;
/// Curve tanh x.
pub(crate) struct Tanh;
/// Curve max(x, 0).
pub(crate) struct Relu;
/// Curve x σ(x).
pub(crate) struct Silu;
/// Curve x Φ(x).
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
        let off = s.less_than_or_equal_f32s(x, zero);
        (s.select_f32s(off, zero, x), s.select_f32s(off, zero, s.splat_f32s(1.0)))
    }
}

impl Curve for Silu {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let (y, rest) = vanishing_sigmoids(s, x);
        let value = s.mul_f32s(x, y);
        (value, s.mul_add_e_f32s(value, rest, y))
    }
}

impl Curve for Gelu {
    #[inline(always)]
    fn at<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
        let (y, bell) = normal(s, x);
        let density = s.mul_f32s(s.splat_f32s(0.398_942_3), bell);
        (s.mul_f32s(x, y), s.mul_add_e_f32s(x, density, y))
    }
}

/// A piece of work that needs an activation.
pub(crate) trait WithCurve {
    /// Does the work with the activation `F`.
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

#[cfg(test)]
mod tests;
