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

use acm_kernels::{Body, GruShape, Keep, Kernel};
use burn::module::{Module, Param};
use burn::tensor::{Device, Tensor, activation::sigmoid};
use serde::{Deserialize, Serialize};

use crate::architecture::{Architecture, ConfigError, check_count, checked};
use crate::parameters::first_values::FirstValues;
use crate::pass::{Answer, Fused, Reference, Window, pass};
use crate::steps::Steps;

/// The recurrent unit's sizes.
///
/// ```
/// use acm_models::GruConfig;
/// use acm_models::burn::tensor::{Device, Tensor};
///
/// let device = Device::flex();
/// let gru = GruConfig::new(5).with_units(32).with_layers(2).init(&device);
/// let (states, last) = gru.forward_from(Tensor::zeros([8, 20, 5], &device), gru.initial_state(8, &device));
/// assert_eq!((states.dims(), last.dims()), ([8, 20, 32], [2, 8, 32]));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GruConfig {
    /// Number of channels C. Not in files, which leave it to the data.
    #[serde(skip)]
    pub inputs: usize,
    /// Width H of the state.
    pub units: usize,
    /// Number of layers, each reading the states of the one below.
    pub layers: usize,
}

impl Default for GruConfig {
    fn default() -> Self {
        Self { inputs: 0, units: 32, layers: 1 }
    }
}

impl GruConfig {
    /// Returns the default sizes for `inputs` channels.
    pub fn new(inputs: usize) -> Self {
        Self { inputs, ..Self::default() }
    }

    /// Sets the number of units H.
    #[must_use]
    pub fn with_units(self, units: usize) -> Self {
        Self { units, ..self }
    }

    /// Sets the number of layers.
    #[must_use]
    pub fn with_layers(self, layers: usize) -> Self {
        Self { layers, ..self }
    }

    /// Returns the network with first values from burn's generator.
    ///
    /// # Panics
    /// If a size cannot be built; [`validate`](Architecture::validate) says so without a panic.
    pub fn init(&self, device: &Device) -> Gru {
        self.build(&mut FirstValues::of_burn(device))
    }

    /// Returns the network with first values that follow from `seed` alone.
    ///
    /// # Panics
    /// As [`init`](Self::init).
    pub fn init_seeded(&self, seed: u64, device: &Device) -> Gru {
        self.build(&mut FirstValues::seeded(seed, device))
    }

    pub(crate) fn build(&self, first: &mut FirstValues) -> Gru {
        checked(self, self.inputs);
        let layers = (0..self.layers)
            .map(|l| GruLayer::new(if l == 0 { self.inputs } else { self.units }, self.units, first))
            .collect();
        let fused = Fused::new(Kernel::without_head(&self.body(), self.inputs).expect("sizes are checked"));
        Gru { layers, config: self.clone(), fused }
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

    fn body(&self) -> Body {
        Body::Gru(GruShape { units: self.units, layers: self.layers })
    }
}

/// One layer of a [`Gru`]. Gates lie one below the other: r, z, n.
#[derive(Module, Debug)]
pub struct GruLayer {
    /// Weights W_i, `[3H,C]`.
    pub weight_ih: Param<Tensor<2>>,
    /// Weights W_h, `[3H,H]`.
    pub weight_hh: Param<Tensor<2>>,
    /// Biases b_i, `[3H]`.
    pub bias_ih: Param<Tensor<1>>,
    /// Biases b_h, `[3H]`.
    pub bias_hh: Param<Tensor<1>>,
}

impl GruLayer {
    fn new(inputs: usize, units: usize, first: &mut FirstValues) -> Self {
        let (gates, bound) = (3 * units, 1.0 / (units as f64).sqrt());
        Self {
            weight_ih: first.next([gates, inputs], bound),
            weight_hh: first.next([gates, units], bound),
            bias_ih: first.next([gates], bound),
            bias_hh: first.next([gates], bound),
        }
    }

    /// Returns h' of the equations at the head of this file.
    fn next_state(&self, u: Tensor<2>, h: Tensor<2>) -> Tensor<2> {
        let map = |x: Tensor<2>, weight: &Param<Tensor<2>>, bias: &Param<Tensor<1>>| {
            (x.matmul(weight.val().transpose()) + bias.val().unsqueeze::<2>()).chunk(3, 1)
        };
        let input = map(u, &self.weight_ih, &self.bias_ih);
        let state = map(h.clone(), &self.weight_hh, &self.bias_hh);
        let sum = |k: usize| input[k].clone() + state[k].clone();
        let (r, z) = (sigmoid(sum(0)), sigmoid(sum(1)));
        let n = (input[2].clone() + r * state[2].clone()).tanh();
        z.clone().neg().add_scalar(1.0) * n + z * h
    }
}

/// Gated recurrent unit of one or more layers; see the head of `gru.rs` for its equations.
///
/// Made by [`GruConfig`]. Its parameters are those of `torch.nn.GRU`, and lie as there.
#[derive(Module, Debug)]
pub struct Gru {
    /// Layers, from the inputs up.
    pub layers: Vec<GruLayer>,
    #[module(skip)]
    config: GruConfig,
    #[module(skip)]
    fused: Fused,
}

impl Gru {
    /// Returns the states of the uppermost layer at every step, from the state zero.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - result: `[B,W,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward(&self, inputs: Tensor<3>) -> Tensor<3> {
        pass(self, Window { inputs, elapsed: None, state: Vec::new(), keep: Keep::Every }, false).rows
    }

    /// Returns the states of the uppermost layer at every step, from a given state, and the state of all layers after
    /// the last.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - state: `[layers,B,H]`
    /// - results: `[B,W,H]`, `[layers,B,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward_from(&self, inputs: Tensor<3>, state: Tensor<3>) -> (Tensor<3>, Tensor<3>) {
        let [layers, ..] = state.dims();
        let state = (0..layers).map(|l| state.clone().narrow(0, l, 1).squeeze_dim(0)).collect();
        let Answer { rows, last } = pass(self, Window { inputs, elapsed: None, state, keep: Keep::Every }, true);
        (rows, Tensor::stack(last, 0))
    }

    /// Returns the state of all layers after one step; the uppermost is the answer.
    ///
    /// # Shapes
    /// - input: `[B,C]`
    /// - state: `[layers,B,H]`
    /// - result: `[layers,B,H]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn step(&self, input: Tensor<2>, state: Tensor<3>) -> Tensor<3> {
        self.forward_from(input.unsqueeze_dim(1), state).1
    }

    /// Returns the state before the first step: zeros.
    ///
    /// # Shapes
    /// - result: `[layers,B,H]`
    pub fn initial_state(&self, batch: usize, device: &Device) -> Tensor<3> {
        Tensor::zeros([self.config.layers, batch, self.config.units], device)
    }

    /// Returns the network in burn's operations on every device: slower on CPUs, and the reference for the fused
    /// operation.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { fused: Fused::none(), ..self }
    }

    /// Returns the sizes of the network.
    pub fn config(&self) -> &GruConfig {
        &self.config
    }
}

impl Reference for Gru {
    fn fused(&self) -> &Fused {
        &self.fused
    }

    fn state_widths(&self) -> Vec<usize> {
        vec![self.config.units; self.config.layers]
    }

    fn run(&self, steps: &Steps, mut state: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>) {
        let mut rows = steps.inputs.clone();
        for (layer, h) in self.layers.iter().zip(&mut state) {
            for row in &mut rows {
                *h = layer.next_state(row.clone(), h.clone());
                *row = h.clone();
            }
        }
        if keep == Keep::Last {
            rows.drain(..rows.len() - 1);
        }
        (Tensor::stack(rows, 1), state)
    }
}
