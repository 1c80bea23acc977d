//! The functions against double precision, on every level of this processor.

use pulp::WithSimd;

use super::*;
use crate::vectors::level::{Level, run};
use crate::vectors::row::Row;

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
        for x in self.0.iter_mut().flat_map(Row::vectors_mut::<S>) {
            *x = F::at(s, *x);
        }
    }
}

/// Every 2039th number of single precision from −limit to limit.
fn grid(limit: f32) -> Vec<f32> {
    let positive: Vec<_> = (0..=limit.to_bits()).step_by(2039).map(f32::from_bits).collect();
    positive.iter().map(|x| -x).chain(positive.iter().copied()).collect()
}

/// Greatest error on the grid; in proportion to |f| above one, or above 1e-30 if `relative`.
fn worst<F: Function>(level: Level, limit: f32, relative: bool, exact: impl Fn(f64) -> f64) -> f64 {
    let arch = level.arch().expect("the level is available");
    let mut most = 0f64;
    for xs in grid(limit).chunks(crate::vectors::row::ROWS * 64) {
        let mut rows = vec![Row::ZERO; 64];
        for (row, xs) in rows.iter_mut().zip(xs.chunks(crate::vectors::row::ROWS)) {
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

#[test]
fn what_is_no_number_stays_so() {
    fn through<F: Function>(level: Level) -> f32 {
        let mut rows = [Row([f32::NAN; crate::vectors::row::ROWS])];
        run(level.arch().expect("the level is available"), Apply::<F>(&mut rows, std::marker::PhantomData));
        rows[0].0.iter().sum()
    }
    for level in Level::available() {
        let results = [
            through::<OfTanh>(level),
            through::<OfSigmoid>(level),
            through::<OfExp>(level),
            through::<OfSilu>(level),
            through::<OfGelu>(level),
            through::<OfLecun>(level),
            through::<OfRelu>(level),
        ];
        assert!(results.iter().all(|y| y.is_nan()), "{level:?}: {results:?}");
    }
}
