//! What was recorded: the rig, its trials, and their clock.

pub mod clock_correction;
mod derivatives;
mod derived;
pub mod inter_sample;
pub mod record;
pub mod rig;
pub mod slope;
pub mod starts;
