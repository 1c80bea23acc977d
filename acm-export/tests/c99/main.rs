//! The estimator in C against the estimator in Rust, which shares no code with it.
//!
//! Compilers that are not there are named, and their tests skipped.

mod alone;
mod averages;
mod compile;
mod effects;
mod names;
mod networks;
mod nominal;
mod refusals;
mod robots;
mod source;
