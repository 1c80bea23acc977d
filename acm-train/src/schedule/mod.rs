//! Many runs: planning, engines, studies, and their tables.

pub mod answer;
pub mod descriptive;
pub mod engine;
mod error;
pub mod import;
pub mod job;
pub mod kubernetes;
pub mod open;
pub mod plans;
pub mod queue;
pub mod ready;
pub mod request;
pub mod sequences;
pub mod slurm;
pub mod study;

pub use error::ScheduleError;
