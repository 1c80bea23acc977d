//! Joining several recordings of a trial, each with its own clock.
//!
//! ```text
//! files → signals on their own clocks → alignment (offset, drift) → at the reference's samples → one Recording a trial
//! t_ref = t + offset + drift·(t − t_0)          t_0: source time at the trial's start, where the offset holds
//! ```
//!
//! The trial's samples are those of the reference. What another source does not have there is an empty cell: before its first
//! sample, behind its last, and in its gaps.

pub(crate) mod clock;
mod files;
pub(crate) mod jump;
mod plan;
mod quality;
mod resample;
mod sampled;
mod series;
pub(crate) mod signals;
mod view;
mod write;

pub use clock::align::{Alignment, How};
pub use clock::estimate::{Estimate, Refusal, Request, estimate};
pub(crate) use plan::Plan;
pub use quality::Quality;
pub use resample::{Onto, Rule, resample, slerp};
pub use series::Series;
pub(crate) use series::median;
pub use view::Line;
pub use write::write;

pub use crate::ingest::layout::JOINED_TIME as TIME;
