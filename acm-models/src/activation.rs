//! Activations of hidden layers, as torch defines them.

use burn::tensor::{Tensor, activation};
use serde::{Deserialize, Serialize};

use crate::off_tape::{elementwise, tanh, tanh_slope};

/// An elementwise function between two layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activation {
    /// 1.7159 tanh(0.666 x). LeCun et al. (1998), Efficient BackProp, section 4.4.
    LecunTanh,
    /// tanh x.
    Tanh,
    /// max(x, 0).
    Relu,
    /// x σ(x).
    Silu,
    /// x Φ(x), with the normal distribution Φ.
    Gelu,
}

impl Activation {
    /// All of them, for tests that walk the list.
    pub const ALL: [Self; 5] = [Self::LecunTanh, Self::Tanh, Self::Relu, Self::Silu, Self::Gelu];

    /// The function at each element of x.
    pub(crate) fn apply(self, x: Tensor<2>) -> Tensor<2> {
        match self {
            Self::LecunTanh => scaled_tanh(x, 1.7159, 0.666),
            Self::Tanh => scaled_tanh(x, 1.0, 1.0),
            Self::Relu => activation::relu(x),
            Self::Silu => activation::silu(x),
            Self::Gelu => activation::gelu(x),
        }
    }
}

/// a tanh(b x).
fn scaled_tanh(x: Tensor<2>, a: f64, b: f64) -> Tensor<2> {
    elementwise(x, |x| {
        let y = tanh(x.mul_scalar(b));
        let slope = tanh_slope(&y).mul_scalar(a * b);
        (y.mul_scalar(a), slope)
    })
}
