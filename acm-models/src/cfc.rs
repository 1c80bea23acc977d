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

use acm_kernels::{Activation, Body, CfcMode, CfcShape};
use burn::tensor::{Tensor, activation::sigmoid};
use serde::{Deserialize, Serialize};

use crate::activation::apply;
use crate::affine::linear;
use crate::architecture::{Architecture, ConfigError, Keep, check_count};
use crate::parameter::{Blueprint, Weights, xavier_bound};
use crate::steps::Steps;

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

    fn body(&self) -> Body {
        Body::Cfc(CfcShape {
            units: self.units,
            mode: self.mode,
            backbone_units: self.backbone_units,
            backbone_layers: self.backbone_layers,
            activation: self.activation,
        })
    }

    fn run(&self, weights: &Weights, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let mut h = state.into_iter().next().expect("state_widths asks for one state");
        let mut kept = Vec::new();
        for (u, elapsed) in steps.inputs.iter().zip(&steps.elapsed) {
            let eta = Tensor::cat(vec![u.clone(), h], 1);
            let layer = |x, name: String| apply(self.activation, linear(weights, &name, x));
            let psi = self.backbone_names().fold(eta, layer);
            h = self.next_state(weights, psi, elapsed.clone());
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

impl CfcConfig {
    /// h' of the head of this file.
    fn next_state(&self, weights: &Weights, psi: Tensor<2>, elapsed: Tensor<2>) -> Tensor<2> {
        let map = |name: &str| linear(weights, name, psi.clone());
        let gate = || sigmoid(map("time_a") * elapsed.clone() + map("time_b"));
        match self.mode {
            CfcMode::Default => {
                let alpha = gate();
                let beta = alpha.clone().neg().add_scalar(1.0);
                beta * map("ff1").tanh() + alpha * map("ff2").tanh()
            }
            CfcMode::NoGate => map("ff1").tanh() + gate() * map("ff2").tanh(),
            CfcMode::Pure => {
                let (level, n_1) = (weights.get("A"), map("ff1"));
                let rate = weights.get("w_tau").abs() + n_1.clone().abs();
                level.clone() - level * (rate * elapsed.clone()).neg().exp() * n_1
            }
        }
    }
}
