//! What a network must say about itself: its parameters and its forward pass.

use std::fmt::Debug;

pub use acm_kernels::Keep;

use acm_kernels::Body;
use burn::tensor::Tensor;
use thiserror::Error;

use crate::parameter::{Blueprint, Weights};
use crate::steps::Steps;

/// A value in a network's configuration that cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("network {kind}: {field} = {value} cannot be built; {remedy}")]
pub struct ConfigError {
    /// Which network, as `kind` names it.
    pub kind: &'static str,
    /// Which field.
    pub field: &'static str,
    /// What was found there.
    pub value: String,
    /// What to write instead.
    pub remedy: &'static str,
}

/// A network's configuration, and through it the network.
///
/// An implementation holds numbers only; tensors arrive as [`Weights`]. The linear output layer is
/// the same for all networks and lives in [`crate::Network`].
pub trait Architecture: Debug {
    /// The name under which files ask for it.
    fn kind(&self) -> &'static str;

    /// Refuses what cannot be built.
    ///
    /// # Errors
    /// Names the field, its value and what to write instead.
    fn validate(&self) -> Result<(), ConfigError>;

    /// The trainable parameters for `inputs` channels, in the order of torch's `named_parameters`.
    fn blueprints(&self, inputs: usize) -> Vec<Blueprint>;

    /// Width F of the rows that [`run`](Self::run) hands to the output layer.
    fn features(&self, inputs: usize) -> usize;

    /// Width of each state that is carried from step to step; empty without memory.
    fn state_widths(&self) -> Vec<usize>;

    /// The same network for the fused kernels.
    fn body(&self) -> Body;

    /// The forward pass in plain tensor operations, which any device has.
    ///
    /// `state` holds one [B, width] tensor for each entry of
    /// [`state_widths`](Self::state_widths). Rows come back time-major: `[B,F]` for
    /// [`Keep::Last`], [W·B, F] for [`Keep::Every`].
    fn run(&self, weights: &Weights, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2>;
}

/// Refuses a count outside 1 ..= `most`.
pub(crate) fn check_count(
    kind: &'static str,
    field: &'static str,
    value: usize,
    most: usize,
    remedy: &'static str,
) -> Result<(), ConfigError> {
    if (1..=most).contains(&value) {
        return Ok(());
    }
    Err(ConfigError { kind, field, value: value.to_string(), remedy })
}
