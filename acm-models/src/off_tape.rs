//! Elementwise functions that are computed off the tape and put back on it with their slopes.
//!
//! ```text
//! y = f(x₁, …, x_K)  enters the tape as  Σ_k x_k ⊙ J_k + rest,   J_k = ∂f/∂x_k,  rest = y − Σ_k x_k ⊙ J_k
//! ```
//!
//! Value and gradient are those of f, while the tape holds a product and a sum however long f is.
//! burn 0.22 evaluates a sigmoid, a tanh or an exponential again on the way back, and each slice of
//! a tracked tensor costs a tensor of zeros; a recurrent cell made of those takes three times as
//! long. The price is that f's slopes are written by hand, so every user of this file is checked
//! against finite differences and against torch.

use burn::tensor::Tensor;

/// y = f(x) elementwise; `f` returns value and slope, both off the tape.
pub(crate) fn elementwise(x: Tensor<2>, f: impl Fn(Tensor<2>) -> (Tensor<2>, Tensor<2>)) -> Tensor<2> {
    let (value, slope) = f(x.clone().inner());
    if x.is_tracked() { attach(x * slope, value) } else { value }
}

/// The tracked `line` moved to `value`, which it then equals to rounding.
pub(crate) fn attach(line: Tensor<2>, value: Tensor<2>) -> Tensor<2> {
    let rest = value - line.clone().inner();
    line + rest
}

/// Σ_k x_k ⊙ J_k over the K blocks of width H that stand side by side in x: [B, K·H] → [B, H].
pub(crate) fn line<const K: usize>(x: Tensor<2>, slopes: [Tensor<2>; K]) -> Tensor<2> {
    let [batch, width] = x.dims();
    let slopes = Tensor::cat(slopes.into(), 1);
    let blocks = (x * slopes).reshape([batch, K, width / K]);
    blocks.sum_dim(1).reshape([batch, width / K])
}

/// The K blocks of equal width that stand side by side in x.
pub(crate) fn blocks<const K: usize>(x: &Tensor<2>) -> [Tensor<2>; K] {
    let width = x.dims()[1] / K;
    std::array::from_fn(|k| x.clone().narrow(1, k * width, width))
}

/// 1/(1 + e⁻ˣ), for tensors off the tape.
pub(crate) fn sigmoid(x: Tensor<2>) -> Tensor<2> {
    x.neg().exp().add_scalar(1.0).recip()
}

/// tanh x = 2 σ(2x) − 1, for tensors off the tape; five times as fast as the scalar tanh.
pub(crate) fn tanh(x: Tensor<2>) -> Tensor<2> {
    // x + x, since flex multiplies a block of columns with a number element by element.
    sigmoid(x.clone() + x).mul_scalar(2.0).sub_scalar(1.0)
}

/// 1 − y², the slope of tanh where it is y.
pub(crate) fn tanh_slope(y: &Tensor<2>) -> Tensor<2> {
    (y.clone() * y.clone()).neg().add_scalar(1.0)
}

/// y(1 − y), the slope of the sigmoid where it is y.
pub(crate) fn sigmoid_slope(y: &Tensor<2>) -> Tensor<2> {
    y.clone() - y.clone() * y.clone()
}
