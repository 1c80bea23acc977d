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

/// P of the normal distribution's tail, the highest coefficient first, with its half already in it.
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

/// Φ(x), the normal distribution, and e^(−x²/2).
#[inline(always)]
fn normal<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
    let one = s.splat_f32s(1.0);
    let bell = exp(s, s.mul_f32s(s.splat_f32s(-0.5), s.mul_f32s(x, x)));
    let t = s.div_f32s(one, s.mul_add_e_f32s(s.splat_f32s(0.212_132_03), s.abs_f32s(x), one));
    let tail = s.mul_f32s(bell, s.mul_f32s(t, polynomial(s, t, TAIL)));
    let below = s.less_than_f32s(x, s.splat_f32s(0.0));
    (s.select_f32s(below, tail, s.sub_f32s(one, tail)), bell)
}

/// σ(x) and σ(−x) = 1 − σ(x), both with a small relative error, for what is multiplied with x.
#[inline(always)]
fn vanishing_sigmoids<S: Simd>(s: S, x: S::f32s) -> (S::f32s, S::f32s) {
    let one = s.splat_f32s(1.0);
    let decay = exp(s, s.neg_f32s(x));
    let y = s.div_f32s(one, s.add_f32s(one, decay));
    (y, s.mul_f32s(decay, y))
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

#[cfg(test)]
mod tests {
    use pulp::WithSimd;

    use super::*;
    use crate::level::{Level, run};
    use crate::row::Row;

    /// A function of a vector that the tests can name.
    trait Function {
        fn at<S: Simd>(s: S, x: S::f32s) -> S::f32s;
    }

    macro_rules! functions {
        ($($name:ident = |$s:ident, $x:ident| $value:expr;)+) => {
            $(struct $name;
            impl Function for $name {
                #[inline(always)]
                fn at<S: Simd>($s: S, $x: S::f32s) -> S::f32s { $value }
            })+
        };
    }

    functions! {
        OfTanh = |s, x| tanh(s, x);
        OfSigmoid = |s, x| sigmoid(s, x);
        OfExp = |s, x| exp(s, x);
        OfSilu = |s, x| Silu::at(s, x).0;
        OfSiluSlope = |s, x| Silu::at(s, x).1;
        OfGelu = |s, x| Gelu::at(s, x).0;
        OfGeluSlope = |s, x| Gelu::at(s, x).1;
        OfLecun = |s, x| LecunTanh::at(s, x).0;
        OfLecunSlope = |s, x| LecunTanh::at(s, x).1;
        OfRelu = |s, x| Relu::at(s, x).0;
    }

    struct Apply<'a, F>(&'a mut [Row], std::marker::PhantomData<F>);

    impl<F: Function> WithSimd for Apply<'_, F> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, s: S) {
            for x in self.0.iter_mut().flat_map(|row| row.vectors_mut::<S>()) {
                *x = F::at(s, *x);
            }
        }
    }

    /// Every 1021st number of single precision from −limit to limit.
    fn grid(limit: f32) -> Vec<f32> {
        let positive: Vec<_> = (0..=limit.to_bits()).step_by(1021).map(f32::from_bits).collect();
        positive.iter().map(|x| -x).chain(positive.iter().copied()).collect()
    }

    /// Greatest error on the grid; in proportion to |f| above one, or above 1e-30 if `relative`.
    fn worst<F: Function>(level: Level, limit: f32, relative: bool, exact: impl Fn(f64) -> f64) -> f64 {
        let arch = level.arch().expect("the level is available");
        let mut most = 0f64;
        for xs in grid(limit).chunks(crate::row::ROWS * 64) {
            let mut rows = vec![Row::ZERO; 64];
            for (row, xs) in rows.iter_mut().zip(xs.chunks(crate::row::ROWS)) {
                row.0[..xs.len()].copy_from_slice(xs);
            }
            run(arch, Apply::<F>(&mut rows, std::marker::PhantomData));
            for (&x, &y) in xs.iter().zip(rows.iter().flat_map(|row| &row.0)) {
                let exact = exact(f64::from(x));
                let scale = exact.abs().max(if relative { 1e-30 } else { 1.0 });
                let error = (f64::from(y) - exact).abs() / scale;
                most = if error > most || error.is_nan() { error } else { most };
            }
        }
        most
    }

    /// 1 + erf(x/√2) over 2, by the series and by the continued fraction.
    fn normal_exactly(x: f64) -> f64 {
        let a = x.abs() / 2f64.sqrt();
        let erfc = if a < 2.5 {
            let (mut term, mut sum) = (a, a);
            for n in 1..80 {
                term *= -a * a / f64::from(n);
                sum += term / f64::from(2 * n + 1);
            }
            1.0 - sum * 2.0 / std::f64::consts::PI.sqrt()
        } else {
            let fraction = (1..60).rev().fold(a, |rest, n| a + f64::from(n) / 2.0 / rest);
            (-a * a).exp() / (fraction * std::f64::consts::PI.sqrt())
        };
        if x > 0.0 { 1.0 - erfc / 2.0 } else { erfc / 2.0 }
    }

    /// Oracle: double precision, on a grid over all exponents and signs.
    #[test]
    fn functions_are_good_to_three_in_ten_million() {
        let logistic = |x: f64| 1.0 / (1.0 + (-x).exp());
        let lecun = |x: f64| 1.7159 * (0.666 * x).tanh();
        for level in Level::available() {
            // Without fused multiply-add each step of Horner's rule is rounded twice.
            let tolerance = if level == Level::Scalar { 5e-7 } else { 3e-7 };
            let check = |what: &str, error: f64, tolerance: f64| {
                eprintln!("{level:?} {what}: {error:.2e}");
                assert!(error <= tolerance, "{level:?} {what}: {error:.2e}");
            };
            check("tanh", worst::<OfTanh>(level, 1e30, false, f64::tanh), tolerance);
            check("tanh, relative", worst::<OfTanh>(level, 1e30, true, f64::tanh), 2.0 * tolerance);
            check("sigmoid", worst::<OfSigmoid>(level, 1e30, false, logistic), tolerance);
            check("exp", worst::<OfExp>(level, 85.0, true, f64::exp), tolerance);
            check("silu", worst::<OfSilu>(level, 1e6, false, |x| x * logistic(x)), tolerance);
            let slope = |x: f64| logistic(x) * (1.0 + x * (1.0 - logistic(x)));
            check("silu's slope", worst::<OfSiluSlope>(level, 1e6, false, slope), tolerance);
            check("gelu", worst::<OfGelu>(level, 1e6, false, |x| x * normal_exactly(x)), tolerance);
            let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
            let slope = |x: f64| normal_exactly(x) + x * density(x);
            check("gelu's slope", worst::<OfGeluSlope>(level, 1e6, false, slope), 2.0 * tolerance);
            check("lecun tanh", worst::<OfLecun>(level, 1e6, false, lecun), tolerance);
            let slope = |x: f64| 1.7159 * 0.666 * (1.0 - (0.666 * x).tanh().powi(2));
            check("lecun tanh's slope", worst::<OfLecunSlope>(level, 1e6, false, slope), 2.0 * tolerance);
            check("relu", worst::<OfRelu>(level, 1e30, false, |x| x.max(0.0)), 0.0);
        }
    }
}
