//! Gated recurrent unit, with torch's equations.
//!
//! ```text
//! r  = σ(W_ir u + b_ir + W_hr h + b_hr)
//! z  = σ(W_iz u + b_iz + W_hz h + b_hz)
//! n  = tanh(W_in u + b_in + r ⊙ (W_hn h + b_hn))
//! h' = (1 − z) ⊙ n + z ⊙ h
//! ```
//!
//! | symbol    | meaning                          | shape |
//! | --------- | -------------------------------- | ----- |
//! | `u`       | input of the layer               | [B,C] |
//! | `h, h'`   | state before and after the step  | [B,H] |
//! | `r, z, n` | reset, update, candidate         | [B,H] |
//!
//! The reset acts after the matrix product, as in `torch.nn.GRU`; Cho et al. (2014) has it before.
//! Elapsed time is not used.

use acm_kernels::{Body, GruShape};
use burn::tensor::{Tensor, activation::sigmoid};
use serde::{Deserialize, Serialize};

use crate::architecture::{Architecture, ConfigError, Keep, check_count};
use crate::parameter::{Blueprint, Weights};
use crate::steps::Steps;

/// The recurrent unit's sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GruConfig {
    /// H, the width of the state.
    pub units: usize,
    /// Layers, each reading the states of the one below.
    pub layers: usize,
}

impl Default for GruConfig {
    fn default() -> Self {
        Self { units: 32, layers: 1 }
    }
}

impl Architecture for GruConfig {
    fn kind(&self) -> &'static str {
        "gru"
    }

    fn validate(&self) -> Result<(), ConfigError> {
        check_count("gru", "units", self.units, 8192, "use 1 to 8192, for example units = 32")?;
        check_count("gru", "layers", self.layers, 64, "use 1 to 64, for example layers = 1")
    }

    fn blueprints(&self, inputs: usize) -> Vec<Blueprint> {
        let bound = 1.0 / (self.units as f64).sqrt();
        let gates = 3 * self.units;
        (0..self.layers)
            .flat_map(|l| {
                let below = if l == 0 { inputs } else { self.units };
                [
                    Blueprint::new(format!("weight_ih_l{l}"), &[gates, below], bound),
                    Blueprint::new(format!("weight_hh_l{l}"), &[gates, self.units], bound),
                    Blueprint::new(format!("bias_ih_l{l}"), &[gates], bound),
                    Blueprint::new(format!("bias_hh_l{l}"), &[gates], bound),
                ]
            })
            .collect()
    }

    fn features(&self, _inputs: usize) -> usize {
        self.units
    }

    fn state_widths(&self) -> Vec<usize> {
        vec![self.units; self.layers]
    }

    fn body(&self) -> Body {
        Body::Gru(GruShape { units: self.units, layers: self.layers })
    }

    fn run(&self, weights: &Weights, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let states =
            state.into_iter().enumerate().fold(steps.inputs.clone(), |below, (l, h)| layer(weights, l, &below, h));
        match keep {
            Keep::Last => states[states.len() - 1].clone(),
            Keep::Every => Tensor::cat(states, 0),
        }
    }
}

/// The states of layer `l` over all steps.
fn layer(weights: &Weights, l: usize, inputs: &[Tensor<2>], h: Tensor<2>) -> Vec<Tensor<2>> {
    let states = inputs.iter().scan(h, |h, u| {
        *h = cell(weights, l, u.clone(), h.clone());
        Some(h.clone())
    });
    states.collect()
}

/// h' of the head of this file.
fn cell(weights: &Weights, l: usize, u: Tensor<2>, h: Tensor<2>) -> Tensor<2> {
    let map = |side: &str, x: Tensor<2>| {
        let weight = weights.get(&format!("weight_{side}_l{l}"));
        (x.matmul(weight.transpose()) + weights.get(&format!("bias_{side}_l{l}"))).chunk(3, 1)
    };
    let (input, state) = (map("ih", u), map("hh", h.clone()));
    let sum = |k: usize| input[k].clone() + state[k].clone();
    let (r, z) = (sigmoid(sum(0)), sigmoid(sum(1)));
    let n = (input[2].clone() + r * state[2].clone()).tanh();
    let rest = z.clone().neg().add_scalar(1.0);
    rest * n + z * h
}
