//! Effects on the arm as a load that bends it: weights, wind, and the flow of rotors.

pub(super) mod arms;
pub(super) mod downwash;
pub(super) mod ground_effect;
pub(super) mod self_weight;
pub(super) mod side_wind;
pub(super) mod tip_load;
pub(super) mod wake_lag;
