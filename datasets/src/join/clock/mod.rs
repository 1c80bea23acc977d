//! Clock of a source against the reference's: offsets from an event or from the recorded motion, and drift.

pub(super) mod align;
pub(crate) mod correlate;
pub(crate) mod estimate;
mod event;
mod lag;
pub(crate) mod refine;
pub(crate) mod slope;
