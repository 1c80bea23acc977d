//! One command a file: its arguments, and the story of what it does.

pub mod close_loop;
pub mod export;
pub mod import;
pub mod report;
pub mod score_loop;
pub mod separability;
mod steps;
pub mod stream;
