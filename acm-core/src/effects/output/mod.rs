//! Effects on the outputs that a signal carries, such as friction, inertia and temperature.
//!
//! Delay, filters and drift of the instrument are in [`measurement`], what follows a temperature or another context in [`context`].

pub(super) mod carrying;
pub(super) mod context;
pub(super) mod coulomb_friction;
pub(super) mod dahl_friction;
pub(super) mod inertia;
pub(super) mod joint_gravity;
pub(super) mod lugre_friction;
pub(super) mod measurement;
pub(super) mod output_bouc_wen;
pub(super) mod output_hysteresis;
pub(super) mod output_prandtl_ishlinskii;
pub(super) mod stribeck_friction;
pub(super) mod vibration_mode;
pub(super) mod viscous_friction;
