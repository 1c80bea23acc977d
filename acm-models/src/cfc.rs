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
//! | `Δt`             | time since the previous step            | [B,1]   | s    |
//! | `N_1 N_2 N_a N_b` | affine maps of ψ                     | [B,H]   | –, –, 1/s, – |
//! | `w_τ, A`         | decay rate and level of mode pure     | [1,H]   | 1/s, – |
//!
//! The backbone is zero or more affine layers with an activation; without one ψ = η. Names, order
//! and first values are those of ncps 1.0 (`CfCCell`), whose Xavier rule covers w_τ and A too.
#![expect(non_snake_case, reason = "ncps calls the level A")]

use acm_kernels::{Activation, Body, CfcMode, CfcShape, Keep, Kernel};
use burn::module::{Module, Param};
use burn::nn::Linear;
use burn::tensor::{Device, Tensor, activation::sigmoid};
use serde::{Deserialize, Serialize};

use crate::activation::apply;
use crate::architecture::{Architecture, ConfigError, check_count, checked};
use crate::parameters::first_values::{FirstValues, xavier_bound};
use crate::pass::{Fused, Reference, Window, pass};
use crate::steps::Steps;

/// The network's sizes.
///
/// ```
/// use acm_models::CfcConfig;
/// use acm_models::burn::tensor::{Device, Tensor};
///
/// let device = Device::flex();
/// let cfc = CfcConfig::new(5).with_units(32).init(&device);
/// let states = cfc.forward(Tensor::zeros([8, 20, 5], &device), Tensor::full([8, 20], 0.1, &device));
/// assert_eq!(states.dims(), [8, 20, 32]);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CfcConfig {
    /// Number of channels C. Not in files, which leave it to the data.
    #[serde(skip)]
    pub inputs: usize,
    /// Width H of the state.
    pub units: usize,
    /// Mode, the equation of the new state.
    pub mode: CfcMode,
    /// Width of each backbone layer.
    pub backbone_units: usize,
    /// Number of backbone layers; 0 for none.
    pub backbone_layers: usize,
    /// Activation between backbone layers.
    pub activation: Activation,
}

impl Default for CfcConfig {
    fn default() -> Self {
        Self {
            inputs: 0,
            units: 32,
            mode: CfcMode::Default,
            backbone_units: 64,
            backbone_layers: 1,
            activation: Activation::LecunTanh,
        }
    }
}

impl CfcConfig {
    /// Returns the default sizes for `inputs` channels.
    pub fn new(inputs: usize) -> Self {
        Self { inputs, ..Self::default() }
    }

    /// Sets the number of units H.
    #[must_use]
    pub fn with_units(self, units: usize) -> Self {
        Self { units, ..self }
    }

    /// Sets the mode, the equation of the new state.
    #[must_use]
    pub fn with_mode(self, mode: CfcMode) -> Self {
        Self { mode, ..self }
    }

    /// Sets a backbone of `layers` layers of `units` units.
    #[must_use]
    pub fn with_backbone(self, layers: usize, units: usize) -> Self {
        Self { backbone_layers: layers, backbone_units: units, ..self }
    }

    /// Sets the activation of the backbone layers.
    #[must_use]
    pub fn with_activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// Returns the network with first values from burn's generator.
    ///
    /// # Panics
    /// If a size cannot be built; [`validate`](Architecture::validate) says so without a panic.
    pub fn init(&self, device: &Device) -> Cfc {
        self.build(&mut FirstValues::of_burn(device))
    }

    /// Returns the network with first values that follow from `seed` alone.
    ///
    /// # Panics
    /// As [`init`](Self::init).
    pub fn init_seeded(&self, seed: u64, device: &Device) -> Cfc {
        self.build(&mut FirstValues::seeded(seed, device))
    }

    pub(crate) fn build(&self, first: &mut FirstValues) -> Cfc {
        checked(self, self.inputs);
        let (units, width, bound) = (self.units, self.backbone_units, xavier_bound(self.units, 1));
        let pure = self.mode == CfcMode::Pure;
        let [w_tau, level] = [(); 2].map(|()| pure.then(|| first.next([1, units], bound)));
        let eta = self.inputs + units;
        let backbone: Vec<_> =
            (0..self.backbone_layers).map(|l| first.xavier_linear(if l == 0 { eta } else { width }, width)).collect();
        let psi = if backbone.is_empty() { eta } else { width };
        let ff1 = first.xavier_linear(psi, units);
        let [ff2, time_a, time_b] = [(); 3].map(|()| (!pure).then(|| first.xavier_linear(psi, units)));
        let fused = Fused::new(Kernel::without_head(&self.body(), self.inputs).expect("sizes are checked"));
        Cfc { w_tau, A: level, backbone, ff1, ff2, time_a, time_b, config: self.clone(), fused }
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

    fn body(&self) -> Body {
        Body::Cfc(CfcShape {
            units: self.units,
            mode: self.mode,
            backbone_units: self.backbone_units,
            backbone_layers: self.backbone_layers,
            activation: self.activation,
        })
    }
}

/// Closed-form continuous-time network; see the head of `cfc.rs` for its equations.
///
/// Made by [`CfcConfig`]. Its fields are named as the parameters of ncps' `CfCCell`.
#[derive(Module, Debug)]
pub struct Cfc {
    /// Rates w_τ, `[1,H]`, in 1/s; mode pure alone.
    pub w_tau: Option<Param<Tensor<2>>>,
    /// Levels A, `[1,H]`; mode pure alone.
    pub A: Option<Param<Tensor<2>>>,
    /// Layers from η to ψ.
    pub backbone: Vec<Linear>,
    /// Linear layer N_1.
    pub ff1: Linear,
    /// Linear layer N_2; not in mode pure.
    pub ff2: Option<Linear>,
    /// Linear layer N_a, in 1/s; not in mode pure.
    pub time_a: Option<Linear>,
    /// Linear layer N_b; not in mode pure.
    pub time_b: Option<Linear>,
    #[module(skip)]
    config: CfcConfig,
    #[module(skip)]
    fused: Fused,
}

impl Cfc {
    /// Returns the states at every step, from the state zero.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - elapsed: `[B,W]`, time since the previous step in s
    /// - result: `[B,W,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<3> {
        let window = Window { inputs, elapsed: Some(elapsed), state: Vec::new(), keep: Keep::Every };
        pass(self, window, false).rows
    }

    /// Returns the states at every step, from a given state. The last is the initial state of the next piece.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - elapsed: `[B,W]`, time since the previous step in s
    /// - state: `[B,H]`
    /// - result: `[B,W,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward_from(&self, inputs: Tensor<3>, elapsed: Tensor<2>, state: Tensor<2>) -> Tensor<3> {
        let window = Window { inputs, elapsed: Some(elapsed), state: vec![state], keep: Keep::Every };
        pass(self, window, false).rows
    }

    /// Returns the state after one step.
    ///
    /// # Shapes
    /// - input: `[B,C]`
    /// - elapsed: `[B,1]`, time since the previous step in s
    /// - state: `[B,H]`
    /// - result: `[B,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn step(&self, input: Tensor<2>, elapsed: Tensor<2>, state: Tensor<2>) -> Tensor<2> {
        self.forward_from(input.unsqueeze_dim(1), elapsed, state).squeeze_dim(1)
    }

    /// Returns the state before the first step: zeros.
    ///
    /// # Shapes
    /// - result: `[B,H]`
    pub fn initial_state(&self, batch: usize, device: &Device) -> Tensor<2> {
        Tensor::zeros([batch, self.config.units], device)
    }

    /// Returns the network in burn's operations on every device: slower on CPUs, and the reference for the fused
    /// operation.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { fused: Fused::none(), ..self }
    }

    /// Returns the sizes of the network.
    pub fn config(&self) -> &CfcConfig {
        &self.config
    }

    /// Returns h' of the equations at the head of this file.
    fn next_state(&self, psi: Tensor<2>, elapsed: Tensor<2>) -> Tensor<2> {
        let n_1 = self.ff1.forward(psi.clone());
        if let (Some(w_tau), Some(level)) = (&self.w_tau, &self.A) {
            let (rate, level) = (w_tau.val().abs() + n_1.clone().abs(), level.val());
            return level.clone() - level * (rate * elapsed).neg().exp() * n_1;
        }
        let map = |layer: &Option<Linear>| layer.as_ref().expect("modes with a gate have it").forward(psi.clone());
        let alpha = sigmoid(map(&self.time_a) * elapsed + map(&self.time_b));
        let (a, b) = (n_1.tanh(), map(&self.ff2).tanh());
        match self.config.mode {
            CfcMode::NoGate => a + alpha * b,
            _ => alpha.clone().neg().add_scalar(1.0) * a + alpha * b,
        }
    }
}

impl Reference for Cfc {
    fn fused(&self) -> &Fused {
        &self.fused
    }

    fn state_widths(&self) -> Vec<usize> {
        vec![self.config.units]
    }

    fn run(&self, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>) {
        let mut h = state.into_iter().next().expect("state_widths asks for one state");
        let mut kept = Vec::new();
        for (u, elapsed) in steps.inputs.iter().zip(&steps.elapsed) {
            let eta = Tensor::cat(vec![u.clone(), h], 1);
            let psi = self.backbone.iter().fold(eta, |x, layer| apply(self.config.activation, layer.forward(x)));
            h = self.next_state(psi, elapsed.clone());
            if keep == Keep::Every {
                kept.push(h.clone());
            }
        }
        if keep == Keep::Last {
            kept.push(h.clone());
        }
        (Tensor::stack(kept, 1), vec![h])
    }
}
