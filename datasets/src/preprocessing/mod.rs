//! From trials to the examples of a network.
//!
//! The domain filter drops samples; series hold channels and times between gaps; windows index them; the standardizer scales them.

pub(crate) mod channel;
pub(crate) mod domain;
mod hull;
pub(crate) mod increments;
pub(crate) mod segments;
pub(crate) mod series;
pub(crate) mod standardizer;
pub(crate) mod windows;
