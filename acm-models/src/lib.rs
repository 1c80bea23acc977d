//! Networks over irregularly sampled sequences, as modules of burn: tensors in, tensors out.
//!
//! | network | reads                  | answers                                     |
//! | ------- | ---------------------- | ------------------------------------------- |
//! | [`Cfc`] | channels, elapsed times | its state at each step                     |
//! | [`Gru`] | channels               | the uppermost layer's state at each step    |
//! | [`Mlp`] | channels               | features of each step                       |
//! | [`Network`] | channels, elapsed times | one of these under a linear output layer |
//!
//! | symbol    | meaning                                | shape   | unit         |
//! | --------- | -------------------------------------- | ------- | ------------ |
//! | `inputs`  | channels of the window                 | `[B,W,C]` | standardised |
//! | `elapsed` | time since the sample before           | `[B,W]`   | s            |
//! | result    | state, feature or prediction           | `[B,W,H]`, `[B,W,F]`, `[B,W,O]` | standardised |
//!
//! A network is a field of a module of one's own, which burn's optimizers train and its records store:
//!
//! ```
//! use acm_models::burn::module::Module;
//! use acm_models::burn::nn::{Linear, LinearConfig};
//! use acm_models::burn::tensor::{Device, Tensor};
//! use acm_models::{Cfc, CfcConfig, burn};
//!
//! #[derive(Module, Debug)]
//! struct Sensor {
//!     cfc: Cfc,
//!     head: Linear,
//! }
//!
//! let device = Device::flex().autodiff();
//! let sensor = Sensor { cfc: CfcConfig::new(2).with_units(16).init(&device), head: LinearConfig::new(16, 1).init(&device) };
//! let states = sensor.cfc.forward(Tensor::ones([4, 10, 2], &device), Tensor::full([4, 10], 0.1, &device));
//! let gradients = sensor.head.forward(states).mean().backward();
//! assert!(sensor.cfc.ff1.weight.grad(&gradients).is_some());
//! ```
//!
//! On flex, burn's device for processors, a network is one operation, computed by acm-kernels; elsewhere it is burn's own
//! operations, which stand here as the equations say. `plain()` asks for these on every device. Parameters have the names
//! and first values of torch and ncps; with the feature `store`, module `torch` reads and writes their files.
//!
//! Adding a network is one file and one line in [`networks`]; the contract tests walk that list. This crate knows no robots
//! and no files.

mod activation;
mod architecture;
mod cfc;
mod engine;
mod first_values;
mod flat;
mod fused;
mod gru;
mod mlp;
mod network;
mod networks;
mod pass;
mod steps;
#[cfg(feature = "store")]
pub mod torch;

pub use acm_kernels::{
    Activation, Body, CfcMode, CfcShape, GruShape, Kernel, MlpShape, ParameterShape, Sequences, Shape,
};
pub use architecture::{Architecture, ConfigError, Keep};
pub use cfc::{Cfc, CfcConfig};
pub use engine::Engine;
pub use flat::Parameter;
pub use gru::{Gru, GruConfig, GruLayer};
pub use mlp::{Mlp, MlpConfig};
pub use network::Network;
pub use networks::{AnyBody, NetworkConfig};

/// The tensor library, so that a caller names the same version.
pub use burn;
