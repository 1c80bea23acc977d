//! Small rigs beside the arm: seven kinds, each with formulas of its own and known causes of error.
//!
//! ```text
//! seed → plan (rate, trials, clock, encoders) ─┐
//! seed → ports, inputs on a fine grid ─────────┼→ plant (chain of stages, or sum of terms) → noise → Recorded
//! seed → plant with one to four causes ────────┘                                               └→ oracle
//! ```
//!
//! | kind | output from input | causes |
//! | --- | --- | --- |
//! | [`joint_with_load`] | torque from an angle | inertia, viscous, Coulomb's (of a load), Stribeck's friction, gravity |
//! | [`axis`] | position from a command | second-order loop, dead time, play, stop or dead zone, lag of the sensor |
//! | [`heated_tank`] | temperature from power, level from flow | one or two lags, dead time, ambient, Torricelli's outflow |
//! | [`hardening_spring`] | place from place | second order with cubic stiffness, dead time, stop |
//! | [`sheath`] | way from pull and bend | play that grows with the bend, or many plays; lag, dead time, bend |
//! | [`static_map_motor`] | speed from voltage | lag behind or before a static nonlinearity, dead time |
//! | [`six_joints`] | current from six angles | friction and inertia of one joint |
//!
//! Each trial begins at rest. What an oracle that knows the structure predicts is computed before anything is traced.

pub mod bench;
pub mod draw;
pub mod drive;
mod fit;
mod kind;
mod kinds;
pub mod motion;
mod oracle;
pub mod plan;
mod plants;
mod record;
mod recorded;
mod redraw;

pub use crate::role::Role;
pub use kind::Kind;
pub use kinds::{axis, hardening_spring, heated_tank, joint_with_load, sheath, six_joints, static_map_motor};
pub use oracle::{Oracle, oracle};
pub use plants::{plant, stage, term};
pub use record::simulate;
pub use recorded::{Cause, Counterpart, Recorded, Signal, SimTrial, Truth, Value};
pub use redraw::deviations;
