//! Many runs: planning, engines, studies, and their tables.

pub mod descriptive;
pub mod engine;
mod error;
pub mod import;
pub mod job;
pub mod open;
pub mod plans;
pub mod ready;
pub mod request;
pub mod sequences;
pub mod study;

pub use error::ScheduleError;
