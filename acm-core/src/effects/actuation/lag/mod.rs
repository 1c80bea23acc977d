//! Delay, lag, creep and rate limit of the actuation.

pub(crate) mod actuator_lag;
pub(crate) mod asymmetric_lag;
pub(crate) mod coulomb_damping;
pub(crate) mod creep;
pub(crate) mod dead_time;
pub(crate) mod friction_lag;
pub(crate) mod nonlinear_stiffness;
pub(crate) mod outflow;
pub(crate) mod overflow;
pub(crate) mod rate_limit;
pub(crate) mod second_order_lag;
pub(crate) mod state_dependent_lag;
