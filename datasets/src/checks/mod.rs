//! Checks of what was read: against the manifest, for implausible values, for spoiled samples.

pub(crate) mod consistency;
pub(crate) mod periodic;
pub(crate) mod plausible;
mod suspect;
