//! Play, friction, slip and hysteresis of the actuation.

pub(crate) mod backlash;
pub(crate) mod bouc_wen;
pub(crate) mod dry_friction;
mod length;
pub(crate) mod prandtl_ishlinskii;
pub(crate) mod tendon_friction;
pub(crate) mod viscous_slip;
