//! Effects of a context signal, such as a temperature, on the outputs.

pub(crate) mod context_gain;
pub(crate) mod context_lag;
pub(crate) mod context_term;
