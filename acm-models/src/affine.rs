//! Affine maps.
//!
//! ```text
//! y = x Wᵀ + b
//! ```
//!
//! | symbol | meaning                         | shape            |
//! | ------ | ------------------------------- | ---------------- |
//! | `x`    | rows                            | [B, in]          |
//! | `W, b` | torch's weight and bias         | [out, in], [out] |
//! | `y`    | rows                            | [B, out]         |

use burn::tensor::Tensor;

use crate::parameter::Weights;

/// The layer `name`.
pub(crate) fn linear(weights: &Weights, name: &str, x: Tensor<2>) -> Tensor<2> {
    let weight = weights.get(&format!("{name}.weight"));
    x.matmul(weight.transpose()) + weights.get(&format!("{name}.bias"))
}
