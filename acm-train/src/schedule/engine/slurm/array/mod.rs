//! Job arrays: the runs of an array by index, its batch script and submission, and a task of it.

pub(super) mod digest;
pub(crate) mod list;
pub(super) mod script;
pub(crate) mod submit;
pub mod task;
