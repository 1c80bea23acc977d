//! Fused sequence kernels: forward and backward passes of whole networks, on CPUs.
//!
//! | symbol    | meaning                                | shape            | unit         |
//! | --------- | -------------------------------------- | ---------------- | ------------ |
//! | inputs    | channels of the sequences              | `[B,W,C]`          | standardised |
//! | elapsed   | time since the previous step           | `[B,W]`            | s            |
//! | predictions | at each step, or at the last         | `[B,W,O]` or `[B,O]` | standardised |
//! | parameters | as torch orders and lays them out, the output layer last | one row | – |
//!
//! A [`Kernel`] has a network's shape and no weights; a [`Workspace`] holds every buffer. After the first call with a
//! batch of a size nothing is allocated. A [`Stepper`] answers sample by sample. `DERIVATION.md` derives the passes
//! and the layouts.

#![forbid(unsafe_code)]

mod bodies;
mod kernel;
mod matrix;
pub mod optimizer;
mod parameters;
mod plan;
mod sequences;
mod shape;
mod shard;
mod step;
mod tape;
mod vectors;
mod workspace;

pub use kernel::{Kernel, Loss};
pub use parameters::ParameterShape;
pub use sequences::Sequences;
pub use shape::{Activation, Body, BuildError, CfcMode, CfcShape, GruShape, Keep, MlpShape, Shape};
pub use step::Stepper;
pub use vectors::level::Level;
pub use workspace::Workspace;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
