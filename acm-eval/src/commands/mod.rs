//! One command a file: its arguments and its steps.

pub mod close_loop;
pub mod export;
pub mod import;
pub mod report;
pub mod score_loop;
pub mod separability;
mod steps;
pub mod stream;
