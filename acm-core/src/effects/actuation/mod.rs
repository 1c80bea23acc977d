//! Effects of the actuation, between the reported actuators and the arm.
//!
//! Drift, gain and nonlinearity are here; play, friction and hysteresis are in [`hysteresis`], delays and lags in [`lag`].

pub(super) mod actuators;
mod corner;
pub(super) mod coupling;
pub(super) mod dead_zone;
pub(super) mod encoder_periodic;
pub(super) mod gain_drift;
pub(super) mod hysteresis;
pub(super) mod input_disturbance;
pub(super) mod input_gain;
pub(super) mod input_nonlinearity;
pub(super) mod lag;
pub(super) mod saturation;
pub(super) mod static_gain;
pub(super) mod zero_drift;
