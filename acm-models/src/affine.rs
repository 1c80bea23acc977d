//! Affine maps whose bias is one more row of the matrix.
//!
//! ```text
//! y = [x, 1] · [Wᵀ; bᵀ]
//! ```
//!
//! | symbol | meaning                         | shape            |
//! | ------ | ------------------------------- | ---------------- |
//! | `x`    | rows                            | [B, in]          |
//! | `W, b` | torch's weight and bias         | [out, in], [out] |
//! | `y`    | rows                            | [B, out]         |
//!
//! Several layers that read the same rows are stacked into one matrix. In a recurrent network the
//! matrix is built once a window and used at every step, where each operation saved counts.

use burn::tensor::Tensor;

use crate::parameter::Weights;

/// The layers `names`, side by side: [in + 1, Σ out].
pub(crate) fn stacked(weights: &Weights, names: &[&str]) -> Tensor<2> {
    let part = |field: &str, axis: usize| {
        let parts = names.iter().map(|name| weights.get(&format!("{name}.{field}"))).collect();
        Tensor::cat(parts, axis)
    };
    Tensor::cat(vec![part("weight", 0).transpose(), part("bias", 1)], 0)
}

/// `[x₁, x₂, …, 1]`, the rows that a stacked matrix multiplies.
pub(crate) fn with_one(mut parts: Vec<Tensor<2>>, one: &Tensor<2>) -> Tensor<2> {
    parts.push(one.clone());
    Tensor::cat(parts, 1)
}

/// x · Wᵀ + b, for a layer that is used once.
pub(crate) fn linear(weights: &Weights, name: &str, x: Tensor<2>) -> Tensor<2> {
    let weight = weights.get(&format!("{name}.weight"));
    x.matmul(weight.transpose()) + weights.get(&format!("{name}.bias"))
}
