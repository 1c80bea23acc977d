//! A layer of a perceptron: an affine map, and a function of each of its outputs.

use acm_kernels::Activation;

use super::tables::padded;

/// Returns the name of the C function of an activation.
pub fn activation(activation: Activation) -> &'static str {
    match activation {
        Activation::LecunTanh => "lecun_tanh",
        Activation::Tanh => "tanh_activation",
        Activation::Relu => "relu",
        Activation::Silu => "silu",
        Activation::Gelu => "gelu",
    }
}

/// Writes `a = φ(W x + b)`.
pub fn layer(to: &str, from: &str, map: &str, inputs: usize, outputs: usize, function: &str) -> String {
    let width = padded(outputs);
    format!(
        "    affine({map}, {inputs}, {width}, {from}, {to});\n    for (int j = 0; j < {width}; ++j) {{\n        \
         {to}[j] = {function}({to}[j]);\n    }}\n"
    )
}
