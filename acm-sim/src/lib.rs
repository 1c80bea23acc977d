//! Simulated rigs with known causes of error, for tests of methods that search for effects.
//!
//! | module | contents |
//! | --- | --- |
//! | [`twin`] | a continuum arm under a flying vehicle, with finer physics than the models that are fitted to it |
//! | [`twin::undeclared`] | a quasi-static arm with mechanisms that its manifest does not declare |
//! | [`small_rigs`] | seven kinds of small rigs beside the arm: joints, an axis, tanks, a spring, a sheath, motors |
//!
//! The crate writes no files, and shares no formula with the library of effects.

mod role;
pub mod small_rigs;
pub mod twin;

pub use role::Role;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
