//! Joining several recordings of a trial, each with its own clock.
//!
//! ```text
//! files → signals on their own clocks → alignment (offset, drift) → at the reference's samples → one Recording a trial
//! t_ref = t + offset + drift·(t − t_0)          t_0: source time at the trial's start, where the offset holds
//! ```
//!
//! The trial's samples are those of the reference. What another source does not have there is an empty cell: before its first
//! sample, behind its last, and in its gaps.

mod align;
pub(crate) mod correlate;
pub(crate) mod estimate;
mod event;
mod files;
mod plan;
mod quality;
pub(crate) mod refine;
mod resample;
mod sampled;
mod series;
pub(crate) mod signals;
pub(crate) mod slope;
mod view;
mod write;

pub use align::{Alignment, How};
pub use estimate::{Estimate, Refusal, Request, estimate};
pub(crate) use plan::Plan;
pub use quality::Quality;
pub use resample::{Onto, Rule, resample, slerp, unwrap};
pub use series::Series;
pub use view::Line;
pub use write::write;

pub use crate::layout::JOINED_TIME as TIME;
