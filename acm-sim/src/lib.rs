//! Simulated rigs whose causes of error are known: what looks for effects is tried on them.
//!
//! | module | what |
//! | --- | --- |
//! | [`small_rigs`] | seven kinds of small rigs beside the arm: joints, an axis, tanks, a spring, a sheath, motors |
//!
//! Nothing here knows files, tables or networks, and no formula is shared with the library of effects.

pub mod small_rigs;
