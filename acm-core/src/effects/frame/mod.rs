//! Effects on the place of markers and on the frame in which they are measured.

pub(super) mod base_tilt;
pub(super) mod frames;
pub(super) mod marker_offset;
pub(super) mod misregistration;
pub(super) mod scale;
