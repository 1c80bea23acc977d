//! Affine layer and activation: the step that backbones and perceptrons are made of.
//!
//! ```text
//! forward    a = φ(W x),  slope = φ'(W x)          x has a feature that is one, so W holds the bias
//! backward   d = slope ⊙ ∂L/∂a,   ∂L/∂x = Wᵀ d,   ∂L/∂W = Σ d xᵀ
//! ```
//!
//! The forward pass keeps the slope instead of W x, so the backward pass is a multiplication.

use pulp::Simd;

use crate::matrix::Matrix;
use crate::plan::{Place, Plan};
use crate::shape::Activation;
use crate::vectors::functions::{Curve, WithCurve};
use crate::vectors::row::Row;

/// Places of an affine layer's weights and gradients.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub forward: Place,
    /// Place of the columns whose inputs get a derivative.
    pub backward: Place,
    pub gradient: Place,
}

impl Layer {
    /// Places `matrix` in the plan. The backward pass computes the derivative by `inputs`.
    pub fn new(plan: &mut Plan, matrix: Matrix, inputs: std::ops::Range<usize>) -> Self {
        let back = matrix.part(0..matrix.rows, inputs);
        Self { forward: plan.forward(matrix.clone()), backward: plan.backward(&back), gradient: plan.gradient(matrix) }
    }
}

/// Returns the matrix of torch's linear layers on features (1, x), one below the other; each has the weight [outputs,
/// inputs], then the bias.
pub(crate) fn linear(plan: &mut Plan, inputs: usize, outputs: &[usize]) -> Matrix {
    let mut matrix = Matrix::new(outputs.iter().sum(), 1 + inputs);
    let mut row = 0;
    for &outputs in outputs {
        let (weight, rows) = (plan.parameters(outputs * inputs), row..row + outputs);
        let bias = plan.parameters(outputs);
        matrix = matrix.with(rows.clone(), 0..1, bias, 1).with(rows, 1..1 + inputs, weight, inputs);
        row += outputs;
    }
    matrix
}

/// Replaces x by φ(x). The slopes go to `slopes`, if it has rows.
#[inline(always)]
pub(crate) fn activate<S: Simd>(s: S, activation: Activation, x: &mut [Row], slopes: &mut [Row]) {
    activation.choose(Activate { s, x, slopes });
}

struct Activate<'a, S> {
    s: S,
    x: &'a mut [Row],
    slopes: &'a mut [Row],
}

impl<S: Simd> WithCurve for Activate<'_, S> {
    #[inline(always)]
    fn with<F: Curve>(self) {
        let Self { s, x, slopes } = self;
        if slopes.is_empty() {
            for x in x.iter_mut().flat_map(Row::vectors_mut::<S>) {
                *x = F::at(s, *x).0;
            }
        }
        for (x, slopes) in x.iter_mut().zip(slopes) {
            for (x, slope) in x.vectors_mut::<S>().iter_mut().zip(slopes.vectors_mut::<S>()) {
                (*x, *slope) = F::at(s, *x);
            }
        }
    }
}

/// Replaces x by x ⊙ y.
#[inline(always)]
pub(crate) fn multiply<S: Simd>(s: S, x: &mut [Row], y: &[Row]) {
    for (x, y) in x.iter_mut().zip(y) {
        for (x, &y) in x.vectors_mut::<S>().iter_mut().zip(y.vectors::<S>()) {
            *x = s.mul_f32s(*x, y);
        }
    }
}

/// Replaces x by x + y.
#[inline(always)]
pub(crate) fn add<S: Simd>(s: S, x: &mut [Row], y: &[Row]) {
    for (x, y) in x.iter_mut().zip(y) {
        for (x, &y) in x.vectors_mut::<S>().iter_mut().zip(y.vectors::<S>()) {
            *x = s.add_f32s(*x, y);
        }
    }
}

/// Size below which derivatives are negligible: a single one in a sum of any that matters changes no digit.
const VANISHED: f32 = 1e-30;

/// Flushes subnormal values to zero. Over long windows derivatives fade until they are subnormal, which processors
/// multiply a hundred times as slowly.
#[inline(always)]
pub(crate) fn forget_vanished<S: Simd>(s: S, x: &mut [Row]) {
    let (least, zero) = (s.splat_f32s(VANISHED), s.splat_f32s(0.0));
    for x in x.iter_mut().flat_map(Row::vectors_mut::<S>) {
        *x = s.select_f32s(s.less_than_f32s(s.abs_f32s(*x), least), zero, *x);
    }
}

#[cfg(test)]
mod tests {
    use pulp::WithSimd;

    use super::*;
    use crate::vectors::level::{Level, run};
    use crate::vectors::row::ROWS;

    struct Forget<'x>(&'x mut [Row]);

    impl WithSimd for Forget<'_> {
        type Output = ();

        fn with_simd<S: Simd>(self, s: S) {
            forget_vanished(s, self.0);
        }
    }

    #[test]
    fn what_has_vanished_is_zero_and_nothing_else_changes() {
        let values = [1.0, -3e-29, 9e-31, -1e-38, 1e-42, f32::NAN, -0.5, f32::INFINITY];
        let kept = [1.0, -3e-29, 0.0, 0.0, 0.0, f32::NAN, -0.5, f32::INFINITY];
        for level in Level::available() {
            let mut row = Row::ZERO;
            (0..ROWS).for_each(|lane| row.0[lane] = values[lane % values.len()]);
            run(level.arch().expect("it is available"), Forget(std::slice::from_mut(&mut row)));
            for (lane, found) in row.0.iter().enumerate() {
                let expected = kept[lane % kept.len()];
                assert!(*found == expected || found.is_nan() && expected.is_nan(), "{level:?}: {found} for {expected}");
            }
        }
    }
}
