//! Closed-form continuous-time network. Hasani et al. (2022), Nature Machine Intelligence 4.
//!
//! ```text
//! η = (u_k, h),   ψ = backbone(η),   h' from ψ and the elapsed time Δt:
//!
//! default   h' = (1 − α) ⊙ tanh N_1 + α ⊙ tanh N_2,   α = σ(N_a Δt + N_b)
//! no_gate   h' = tanh N_1 + α ⊙ tanh N_2
//! pure      h' = A − A ⊙ exp(−Δt (|w_τ| + |N_1|)) ⊙ N_1
//! ```
//!
//! | symbol           | meaning                               | shape   | unit |
//! | ---------------- | ------------------------------------- | ------- | ---- |
//! | `u_k`            | input at step k                       | [B,C]   | –    |
//! | `h, h'`          | state before and after the step       | [B,H]   | –    |
//! | `Δt`             | time since the step before            | [B,1]   | s    |
//! | `N_1 N_2 N_a N_b` | affine maps of ψ                     | [B,H]   | –, –, 1/s, – |
//! | `w_τ, A`         | decay rate and level of mode pure     | [1,H]   | 1/s, – |
//!
//! The backbone is zero or more affine layers with an activation; without one ψ = η. Names, order
//! and first values are those of ncps 1.0 (`CfCCell`), whose Xavier rule covers w_τ and A too.

use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

use crate::activation::Activation;
use crate::affine::{stacked, with_one};
use crate::architecture::{Architecture, ConfigError, Keep, check_count};
use crate::off_tape::{attach, blocks, line, sigmoid, sigmoid_slope, tanh, tanh_slope};
use crate::parameter::{Blueprint, Weights, xavier_bound};
use crate::steps::Steps;

/// How the new state is put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CfcMode {
    /// The gate chooses between two candidates.
    Default,
    /// The gate weighs the second candidate only.
    NoGate,
    /// The closed form itself.
    Pure,
}

/// The network's sizes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CfcConfig {
    /// H, the width of the state.
    pub units: usize,
    /// How the new state is put together.
    pub mode: CfcMode,
    /// Width of each backbone layer.
    pub backbone_units: usize,
    /// Number of backbone layers; 0 for none.
    pub backbone_layers: usize,
    /// Between backbone layers.
    pub activation: Activation,
}

impl Default for CfcConfig {
    fn default() -> Self {
        Self {
            units: 32,
            mode: CfcMode::Default,
            backbone_units: 64,
            backbone_layers: 1,
            activation: Activation::LecunTanh,
        }
    }
}

impl CfcConfig {
    /// Names of the affine maps of ψ.
    fn maps(&self) -> &'static [&'static str] {
        match self.mode {
            CfcMode::Pure => &["ff1"],
            CfcMode::Default | CfcMode::NoGate => &["ff1", "ff2", "time_a", "time_b"],
        }
    }

    /// torch numbers the activations between the layers too.
    fn backbone_names(&self) -> impl Iterator<Item = String> + use<> {
        (0..self.backbone_layers).map(|l| format!("backbone.{}", 2 * l))
    }
}

impl Architecture for CfcConfig {
    fn kind(&self) -> &'static str {
        "cfc"
    }

    fn validate(&self) -> Result<(), ConfigError> {
        let remedy = "use 1 to 8192, for example units = 32";
        check_count("cfc", "units", self.units, 8192, remedy)?;
        let remedy = "use 1 to 8192, for example backbone_units = 64";
        check_count("cfc", "backbone_units", self.backbone_units, 8192, remedy)?;
        let remedy = "use 0 to 64, for example backbone_layers = 1";
        check_count("cfc", "backbone_layers", self.backbone_layers.saturating_add(1), 65, remedy)
            .map_err(|error| ConfigError { value: self.backbone_layers.to_string(), ..error })
    }

    fn blueprints(&self, inputs: usize) -> Vec<Blueprint> {
        let mut all = Vec::new();
        if self.mode == CfcMode::Pure {
            let bound = xavier_bound(self.units, 1);
            all.extend(["w_tau", "A"].map(|name| Blueprint::new(name, &[1, self.units], bound)));
        }
        let mut width = inputs + self.units;
        for name in self.backbone_names() {
            all.extend(Blueprint::xavier_linear(&name, width, self.backbone_units));
            width = self.backbone_units;
        }
        for name in self.maps() {
            all.extend(Blueprint::xavier_linear(name, width, self.units));
        }
        all
    }

    fn features(&self, _inputs: usize) -> usize {
        self.units
    }

    fn state_widths(&self) -> Vec<usize> {
        vec![self.units]
    }

    fn run(&self, weights: &Weights, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let backbone: Vec<_> = self.backbone_names().map(|name| stacked(weights, &[&name])).collect();
        let maps = stacked(weights, self.maps());
        let mut h = state.into_iter().next().expect("state_widths asks for one state");
        let mut kept = Vec::new();
        for (u, elapsed) in steps.inputs.iter().zip(&steps.elapsed) {
            let mut psi = with_one(vec![u.clone(), h], &steps.one);
            for layer in &backbone {
                let features = self.activation.apply(psi.matmul(layer.clone()));
                psi = with_one(vec![features], &steps.one);
            }
            let y = psi.matmul(maps.clone());
            h = match self.mode {
                CfcMode::Pure => pure(y, elapsed.clone(), weights),
                CfcMode::Default | CfcMode::NoGate => gated(y, elapsed.clone(), self.mode),
            };
            if keep == Keep::Every {
                kept.push(h.clone());
            }
        }
        match keep {
            Keep::Last => h,
            Keep::Every => Tensor::cat(kept, 0),
        }
    }
}

/// h' = β ⊙ a + α ⊙ b with a = tanh N_1, b = tanh N_2, α = σ(N_a Δt + N_b) and β = 1 − α in mode
/// default, 1 in mode no_gate.
///
/// ```text
/// ∂h'/∂N_1 = β (1 − a²),  ∂h'/∂N_2 = α (1 − b²),  ∂h'/∂N_b = c α(1 − α) =: s,  ∂h'/∂N_a = s Δt,
/// where c = ∂h'/∂α is b − a in mode default and b in mode no_gate
/// ```
fn gated(y: Tensor<2>, elapsed: Tensor<2>, mode: CfcMode) -> Tensor<2> {
    let [n_1, n_2, n_a, n_b] = blocks(&y.clone().inner());
    let (a, b) = (tanh(n_1), tanh(n_2));
    let alpha = sigmoid(n_a * elapsed.clone() + n_b);
    let gated = mode == CfcMode::Default;
    let c = if gated { b.clone() - a.clone() } else { b.clone() };
    let value = a.clone() + alpha.clone() * c.clone();
    if !y.is_tracked() {
        return value;
    }
    let first = tanh_slope(&a);
    let first = if gated { first * alpha.clone().neg().add_scalar(1.0) } else { first };
    let s = c * sigmoid_slope(&alpha);
    let slopes = [first, alpha * tanh_slope(&b), s.clone() * elapsed, s];
    attach(line(y, slopes), value)
}

/// h' = A − A ⊙ exp(−Δt (|w_τ| + |N_1|)) ⊙ N_1.
fn pure(n_1: Tensor<2>, elapsed: Tensor<2>, weights: &Weights) -> Tensor<2> {
    let level = weights.get("A");
    let rate = weights.get("w_tau").abs() + n_1.clone().abs();
    let decay = (rate * elapsed).neg().exp();
    level.clone() - level * decay * n_1
}
