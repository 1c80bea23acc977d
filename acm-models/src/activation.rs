//! Activations of hidden layers in plain tensor operations, as torch defines them.

use acm_kernels::Activation;
use burn::tensor::{Tensor, activation};

/// Returns the function at each element of x.
pub(crate) fn apply(function: Activation, x: Tensor<2>) -> Tensor<2> {
    match function {
        Activation::LecunTanh => x.mul_scalar(0.666).tanh().mul_scalar(1.7159),
        Activation::Tanh => x.tanh(),
        Activation::Relu => activation::relu(x),
        Activation::Silu => activation::silu(x),
        Activation::Gelu => activation::gelu(x),
    }
}
