//! Effects of the measurement on the outputs: delay, filters, drift.

pub(crate) mod measurement_creep;
pub(crate) mod measurement_delay;
pub(crate) mod measurement_drift;
pub(crate) mod measurement_lag;
pub(crate) mod measurement_second_order;
