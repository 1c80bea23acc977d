//! What was recorded: the rig, its trials, and their clock.

pub mod clock_correction;
mod derivatives;
mod derived;
pub mod held;
pub mod record;
pub mod rig;
pub mod slope;
