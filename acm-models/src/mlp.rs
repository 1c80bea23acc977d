//! Multilayer perceptron: no memory, the same map at every time step.
//!
//! ```text
//! a_0 = u_k,   a_l = φ(W_l a_{l−1} + b_l)
//! ```
//!
//! | symbol | meaning                    | shape |
//! | ------ | -------------------------- | ----- |
//! | `u_k`  | input at step k            | [B,C] |
//! | `a_L`  | features, F wide           | [B,F] |
//!
//! Elapsed time is not used.

use acm_kernels::{Activation, Body, Keep, Kernel, MlpShape};
use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::{Device, Tensor};
use serde::{Deserialize, Serialize};

use crate::activation::apply;
use crate::architecture::{Architecture, ConfigError, check_count, checked};
use crate::parameters::first_values::FirstValues;
use crate::pass::{Fused, Reference, Window, pass};
use crate::steps::Steps;

/// The perceptron's sizes.
///
/// ```
/// use acm_models::MlpConfig;
/// use acm_models::burn::tensor::{Device, Tensor};
///
/// let device = Device::flex();
/// let mlp = MlpConfig::new(5).with_hidden(&[64, 32]).init(&device);
/// assert_eq!(mlp.forward(Tensor::zeros([8, 20, 5], &device)).dims(), [8, 20, 32]);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MlpConfig {
    /// Number of channels C. Not in files, which leave it to the data.
    #[serde(skip)]
    pub inputs: usize,
    /// Width of each hidden layer; empty for a linear model.
    pub hidden: Vec<usize>,
    /// Activation φ.
    pub activation: Activation,
}

impl Default for MlpConfig {
    fn default() -> Self {
        Self { inputs: 0, hidden: vec![64, 64], activation: Activation::Relu }
    }
}

impl MlpConfig {
    /// Largest number of units in a layer, and of layers. Larger numbers are more likely a typing error.
    const MOST_UNITS: usize = 8192;
    const MOST_LAYERS: usize = 64;

    /// Returns the default sizes for `inputs` channels.
    pub fn new(inputs: usize) -> Self {
        Self { inputs, ..Self::default() }
    }

    /// Sets the widths of the hidden layers.
    #[must_use]
    pub fn with_hidden(self, hidden: &[usize]) -> Self {
        Self { hidden: hidden.to_vec(), ..self }
    }

    /// Sets the activation φ.
    #[must_use]
    pub fn with_activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// Returns the network with first values from burn's generator.
    ///
    /// # Panics
    /// If a size cannot be built; [`validate`](Architecture::validate) says so without a panic.
    pub fn init(&self, device: &Device) -> Mlp {
        self.build(&mut FirstValues::of_burn(device))
    }

    /// Returns the network with first values that follow from `seed` alone.
    ///
    /// # Panics
    /// As [`init`](Self::init).
    pub fn init_seeded(&self, seed: u64, device: &Device) -> Mlp {
        self.build(&mut FirstValues::seeded(seed, device))
    }

    pub(crate) fn build(&self, first: &mut FirstValues) -> Mlp {
        checked(self, self.inputs);
        let before = std::iter::once(&self.inputs).chain(&self.hidden);
        let layers = before.zip(&self.hidden).map(|(&before, &after)| first.linear(before, after)).collect();
        // Without a hidden layer nothing is to be computed.
        let fused = Kernel::without_head(&self.body(), self.inputs).map_or_else(|_| Fused::none(), Fused::new);
        Mlp { layers, config: self.clone(), fused }
    }
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

    fn body(&self) -> Body {
        Body::Mlp(MlpShape { hidden: self.hidden.clone(), activation: self.activation })
    }
}

/// Multilayer perceptron; see the head of `mlp.rs` for its equations. Every layer is followed by φ.
///
/// Made by [`MlpConfig`].
#[derive(Module, Debug)]
pub struct Mlp {
    /// Layers with W_l and b_l.
    pub layers: Vec<Linear>,
    #[module(skip)]
    config: MlpConfig,
    #[module(skip)]
    fused: Fused,
}

impl Mlp {
    /// Returns the features at every step; the inputs themselves without a hidden layer.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - result: `[B,W,F]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward(&self, inputs: Tensor<3>) -> Tensor<3> {
        if self.layers.is_empty() {
            return inputs;
        }
        pass(self, Window { inputs, elapsed: None, state: Vec::new(), keep: Keep::Every }, false).rows
    }

    /// Returns the features of one step.
    ///
    /// # Shapes
    /// - input: `[B,C]`
    /// - result: `[B,F]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn step(&self, input: Tensor<2>) -> Tensor<2> {
        self.forward(input.unsqueeze_dim(1)).squeeze_dim(1)
    }

    /// Returns the network in burn's operations on every device: slower on CPUs, and the reference for the fused
    /// operation.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { fused: Fused::none(), ..self }
    }

    /// Returns the sizes of the network.
    pub fn config(&self) -> &MlpConfig {
        &self.config
    }
}

impl Reference for Mlp {
    fn fused(&self) -> &Fused {
        &self.fused
    }

    fn state_widths(&self) -> Vec<usize> {
        Vec::new()
    }

    fn run(&self, steps: &Steps, _: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>) {
        let kept = if keep == Keep::Last { &steps.inputs[steps.inputs.len() - 1..] } else { &steps.inputs };
        let (count, batch) = (kept.len(), kept[0].dims()[0]);
        let rows = Tensor::cat(kept.to_vec(), 0);
        let rows = self.layers.iter().fold(rows, |x, layer| apply(self.config.activation, layer.forward(x)));
        let [_, width] = rows.dims();
        (rows.reshape([count, batch, width]).swap_dims(0, 1), Vec::new())
    }
}
