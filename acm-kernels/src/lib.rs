//! Fused sequence kernels: forward and backward passes of whole networks, on processors.
//!
//! | symbol    | meaning                                | shape            | unit         |
//! | --------- | -------------------------------------- | ---------------- | ------------ |
//! | inputs    | channels of the sequences              | `[B,W,C]`          | standardised |
//! | elapsed   | time since the step before             | `[B,W]`            | s            |
//! | predictions | at each step, or at the last         | `[B,W,O]` or `[B,O]` | standardised |
//! | parameters | as torch orders and lays them out, the output layer last | one row | – |
//!
//! A [`Kernel`] knows a network's shape and holds no weights; a [`Workspace`] holds every buffer. After the first
//! call with a batch of some size nothing is allocated. `DERIVATION.md` beside the sources derives the passes and
//! the layouts.

#![forbid(unsafe_code)]

mod bodies;
mod kernel;
mod matrix;
mod parameters;
mod plan;
mod sequences;
mod shape;
mod shard;
mod step;
mod tape;
mod vectors;
mod workspace;

pub use kernel::Kernel;
pub use parameters::ParameterShape;
pub use sequences::Sequences;
pub use shape::{Activation, Body, BuildError, CfcMode, CfcShape, GruShape, Keep, MlpShape, Shape};
pub use step::Stepper;
pub use vectors::level::Level;
pub use workspace::Workspace;
