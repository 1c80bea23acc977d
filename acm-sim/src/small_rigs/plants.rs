//! Plants of small rigs: chains of stages, or sums of terms.

pub mod ode;
pub mod plant;
pub mod stage;
pub mod term;
