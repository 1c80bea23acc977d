//! Nonlinear first-order lags: their friction or time constant depends on the state.

mod asymmetric_lag;
mod stick_lag;
mod varying_lag;

pub use asymmetric_lag::{AsymmetricLag, Decays};
pub use stick_lag::StickLag;
pub use varying_lag::VaryingLag;
