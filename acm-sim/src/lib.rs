//! Simulated rigs whose causes of error are known: what looks for effects is tried on them.
//!
//! | module | what |
//! | --- | --- |
//! | [`twin`] | a continuum arm under a flying vehicle, of finer physics than any model that is fitted to it |
//! | [`twin::undeclared`] | the same arm without memory, and mechanisms that nobody declares |
//! | [`small_rigs`] | seven kinds of small rigs beside the arm: joints, an axis, tanks, a spring, a sheath, motors |
//!
//! Nothing here knows files, tables or networks, and no formula is shared with the library of effects.

mod role;
pub mod small_rigs;
pub mod twin;

pub use role::Role;

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
