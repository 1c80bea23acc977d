//! First-order lags that are not linear: what holds them, or sets their pace, depends on the state.

mod asymmetric_lag;
mod bent_lag;
mod root_lag;
mod stick_lag;

pub use asymmetric_lag::{AsymmetricLag, Decays};
pub use bent_lag::BentLag;
pub use root_lag::RootLag;
pub use stick_lag::StickLag;
