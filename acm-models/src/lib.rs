//! Networks over irregularly sampled sequences: tensors in, tensors out.
//!
//! Every network reads a window and answers with the same signature:
//!
//! | symbol    | meaning                                | shape   | unit         |
//! | --------- | -------------------------------------- | ------- | ------------ |
//! | `inputs`  | channels of the window                 | `[B,W,C]` | standardised |
//! | `elapsed` | time since the sample before           | `[B,W]`   | s            |
//! | result    | prediction at each step, or at the last | `[B,W,O]` or `[B,O]` | standardised |
//!
//! Adding a network is one file that implements [`Architecture`] and one line in [`networks`]; the
//! contract test in `tests/contract.rs` walks that list. This crate knows no robots and no files.

mod activation;
mod affine;
mod architecture;
mod cfc;
mod engine;
mod gru;
mod mlp;
mod network;
mod networks;
mod parameter;
mod sequence;
mod steps;

pub use acm_kernels::{Activation, CfcMode, Sequences};
pub use architecture::{Architecture, ConfigError, Keep};
pub use cfc::CfcConfig;
pub use engine::Engine;
pub use gru::GruConfig;
pub use mlp::MlpConfig;
pub use network::Network;
pub use networks::NetworkConfig;
pub use parameter::{Blueprint, Parameter, Weights};
pub use steps::Steps;

/// The tensor library, so that a caller names the same version.
pub use burn;
