//! MLP, GRU and closed-form continuous-time networks (CfC) over irregularly sampled sequences, as modules of burn.
//!
//! # Where to begin
//!
//! | task | begin with |
//! | --- | --- |
//! | a recurrent layer in a module of your own | [`CfcConfig::init`], [`Cfc::forward`]; [`GruConfig`], [`MlpConfig`] |
//! | a whole network with a linear output layer | [`NetworkConfig`], [`Network`] |
//! | loss and gradient without tensors, on CPUs | [`Engine`] |
//! | the same initial weights on every machine | `init_seeded` of each config |
//! | another device than the CPU | [`device`], features `cuda` and `wgpu` |
//! | files of PyTorch and ncps | feature `store`, module `torch` |
//!
//! # Networks
//!
//! | network | inputs                 | output                                      |
//! | ------- | ---------------------- | ------------------------------------------- |
//! | [`Cfc`] | channels, elapsed times | state at each step                         |
//! | [`Gru`] | channels               | state of the last layer at each step        |
//! | [`Mlp`] | channels               | features of each step                       |
//! | [`Network`] | channels, elapsed times | one of these with a linear output layer  |
//!
//! | symbol    | meaning                                | shape   | unit         |
//! | --------- | -------------------------------------- | ------- | ------------ |
//! | `inputs`  | channels of the window                 | `[B,W,C]` | standardised |
//! | `elapsed` | time since the previous sample         | `[B,W]`   | s            |
//! | result    | state, feature or prediction           | `[B,W,H]`, `[B,W,F]`, `[B,W,O]` | standardised |
//!
//! A network can be a field of your own module, which burn's optimizers train and its records store:
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
//! On flex, burn's CPU device, a network is one operation, computed by acm-kernels. On other devices it consists of burn's own
//! operations. `plain()` selects these on every device. Parameters have the names and initial distributions of torch and ncps.
//!
//! A new network is one file and one line in [`networks`]; the contract tests walk that list. The crate knows no robots.

mod activation;
mod architecture;
mod cfc;
mod device;
mod engine;
mod fused;
mod gru;
mod mlp;
mod network;
mod networks;
mod parameters;
mod pass;
mod steps;
#[cfg(feature = "store")]
pub mod torch;

pub use acm_kernels::{
    Activation, Body, CfcMode, CfcShape, GruShape, Kernel, MlpShape, ParameterShape, Sequences, Shape, Stepper,
};
pub use architecture::{Architecture, ConfigError, Keep};
pub use cfc::{Cfc, CfcConfig};
pub use device::{DEVICES, DeviceError, device};
pub use engine::Engine;
pub use gru::{Gru, GruConfig, GruLayer};
pub use mlp::{Mlp, MlpConfig};
pub use network::Network;
pub use networks::{AnyBody, NetworkConfig};
pub use parameters::first_values::FirstRule;
pub use parameters::flat::Parameter;

/// Adam, AdamW and RMSprop over slices, beside [`Engine`].
pub use acm_kernels::optimizer;

/// The tensor library, so that a caller names the same version.
pub use burn;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
