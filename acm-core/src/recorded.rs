//! What was recorded: the rig, its trials, and their clock.

pub mod clock_correction;
pub mod record;
pub mod rig;
