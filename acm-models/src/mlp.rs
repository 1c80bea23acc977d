//! Multilayer perceptron: no memory, the same map at every time step.
//!
//! ```text
//! a_0 = u_k,   a_l = φ(W_l a_{l−1} + b_l),   output linear in a_L
//! ```

use acm_kernels::{Activation, Body, MlpShape};
use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

use crate::activation::apply;
use crate::affine::linear;
use crate::architecture::{Architecture, ConfigError, Keep, check_count};
use crate::parameter::{Blueprint, Weights};
use crate::steps::Steps;

/// The perceptron's sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MlpConfig {
    /// Width of each hidden layer; empty for a linear model.
    pub hidden: Vec<usize>,
    /// φ.
    pub activation: Activation,
}

impl Default for MlpConfig {
    fn default() -> Self {
        Self { hidden: vec![64, 64], activation: Activation::Relu }
    }
}

impl MlpConfig {
    /// Most units a layer may have, and most layers: beyond these a typing slip is likelier.
    const MOST_UNITS: usize = 8192;
    const MOST_LAYERS: usize = 64;
}

impl Architecture for MlpConfig {
    fn kind(&self) -> &'static str {
        "mlp"
    }

    fn validate(&self) -> Result<(), ConfigError> {
        for &units in &self.hidden {
            let remedy = "each width must be from 1 to 8192, for example hidden = [64, 64]";
            check_count("mlp", "hidden", units, Self::MOST_UNITS, remedy)?;
        }
        let remedy = "list at most 64 layers, for example hidden = [64, 64]";
        check_count("mlp", "hidden", self.hidden.len() + 1, Self::MOST_LAYERS + 1, remedy)
    }

    fn blueprints(&self, inputs: usize) -> Vec<Blueprint> {
        let widths = std::iter::once(&inputs).chain(&self.hidden);
        let layers = widths.zip(&self.hidden).enumerate();
        layers.flat_map(|(l, (&before, &after))| Blueprint::linear(&format!("layers.{l}"), before, after)).collect()
    }

    fn features(&self, inputs: usize) -> usize {
        self.hidden.last().copied().unwrap_or(inputs)
    }

    fn state_widths(&self) -> Vec<usize> {
        Vec::new()
    }

    fn body(&self) -> Body {
        Body::Mlp(MlpShape { hidden: self.hidden.clone(), activation: self.activation })
    }

    fn run(&self, weights: &Weights, steps: &Steps, _: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let rows = match keep {
            Keep::Last => steps.inputs[steps.len() - 1].clone(),
            Keep::Every => steps.rows(),
        };
        (0..self.hidden.len())
            .fold(rows, |rows, l| apply(self.activation, linear(weights, &format!("layers.{l}"), rows)))
    }
}
