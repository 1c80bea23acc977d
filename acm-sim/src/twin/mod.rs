//! The synthetic flight campaign: an arm of finer physics than any model that is fitted to it.
//!
//! ```text
//! schedule, excitation → flight, air, wind, transport ─┐
//!                        cam, tendons, sheath ─────────┼→ equilibrium of the rod at each step → measurement → trials
//!                        creep ────────────────────────┘
//! ```
//!
//! Recordings of the real vehicle are not public, so this campaign stands in for them, and is called synthetic wherever
//! its numbers are shown. It has the statistics of the paper's because its constants were chosen so;
//! that shows that such numbers can come about, and validates nothing. What its physics is made of (a milled cam, ageing
//! friction, a power law, a gamma delay) is not in the library of effects that are looked for in its residuals.

pub mod arm;
pub mod campaign;
pub mod excitation;
pub mod floors;
pub mod measurement;
mod mechanics;
pub mod random;
pub mod rounding;
pub mod schedule;
pub mod settings;
mod surroundings;
pub mod undeclared;
pub mod validate;

pub use campaign::{SyntheticCampaign, SyntheticTrial, TwinError, generate};
pub use floors::{FloorEffort, Floors, floors};
pub use settings::TwinSettings;

/// Seed of the campaign in `datasets/acm-twin`.
pub const SEED: u64 = 3;
pub use mechanics::{cam, creep, equilibrium, rod, sheath, tendons};
pub use surroundings::{air, flight, transport, wind};
