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

use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

use crate::affine::with_one;
use crate::architecture::{Architecture, ConfigError, Keep, check_count};
use crate::off_tape::{attach, blocks, line, sigmoid, sigmoid_slope, tanh, tanh_slope};
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

    fn run(&self, weights: &Weights, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let states = state
            .into_iter()
            .enumerate()
            .fold(steps.inputs.clone(), |below, (l, h)| layer(&joint_matrix(weights, l), &below, &steps.one, h));
        match keep {
            Keep::Last => states[states.len() - 1].clone(),
            Keep::Every => Tensor::cat(states, 0),
        }
    }
}

/// The states of one layer over all steps.
fn layer(matrix: &Tensor<2>, inputs: &[Tensor<2>], one: &Tensor<2>, h: Tensor<2>) -> Vec<Tensor<2>> {
    let states = inputs.iter().scan(h, |h, u| {
        let y = with_one(vec![u.clone(), h.clone()], one).matmul(matrix.clone());
        *h = cell(y, h.clone());
        Some(h.clone())
    });
    states.collect()
}

/// One matrix for `[u, h, 1]` whose columns are the sums inside r, z and n, the last in its two
/// halves because r comes between them: [C + H + 1, 4H].
///
/// ```text
///      r             z       n, input   n, state
/// u    W_irᵀ         W_izᵀ   W_inᵀ      0
/// h    W_hrᵀ         W_hzᵀ   0          W_hnᵀ
/// 1    b_ir + b_hr   …       b_in       b_hn
/// ```
fn joint_matrix(weights: &Weights, l: usize) -> Tensor<2> {
    let input = weights.get(&format!("weight_ih_l{l}")).transpose();
    let state = weights.get(&format!("weight_hh_l{l}")).transpose();
    let [bias_r, bias_z, bias_n] = blocks(&weights.get(&format!("bias_ih_l{l}")));
    let [state_r, state_z, state_n] = blocks(&weights.get(&format!("bias_hh_l{l}")));
    let units = state.dims()[0];
    let zeros = |rows| Tensor::zeros([rows, units], &state.device());
    let (gates, candidate) = (state.clone().narrow(1, 0, 2 * units), state.clone().narrow(1, 2 * units, units));
    let rows = vec![
        Tensor::cat(vec![input.clone(), zeros(input.dims()[0])], 1),
        Tensor::cat(vec![gates, zeros(units), candidate], 1),
        Tensor::cat(vec![bias_r + state_r, bias_z + state_z, bias_n, state_n], 1),
    ];
    Tensor::cat(rows, 0)
}

/// h' from the four sums y = (ρ, ζ, a, c) with r = σ(ρ), z = σ(ζ), n = tanh(a + r c).
///
/// ```text
/// ∂h'/∂a = (1 − z)(1 − n²) =: s,  ∂h'/∂c = s r,  ∂h'/∂ρ = s c r(1 − r),  ∂h'/∂ζ = (h − n) z(1 − z),  ∂h'/∂h = z
/// ```
fn cell(y: Tensor<2>, h: Tensor<2>) -> Tensor<2> {
    let [reset, update, a, c] = blocks(&y.clone().inner());
    let before = h.clone().inner();
    let (r, z) = (sigmoid(reset), sigmoid(update));
    let n = tanh(a + r.clone() * c.clone());
    let over = before - n.clone();
    let value = n.clone() + z.clone() * over.clone();
    if !y.is_tracked() {
        return value;
    }
    let s = tanh_slope(&n) * z.clone().neg().add_scalar(1.0);
    let slopes = [s.clone() * c * sigmoid_slope(&r), over * sigmoid_slope(&z), s.clone(), s * r];
    attach(line(y, slopes) + h * z, value)
}
