//! Judging runs: tables, figures and one self-contained page, drawn from records.
//!
//! ```text
//! run folders ─ Run::read ─▶ runs ─ sections ─▶ one Section per data set ─┬─ tables::ALL  ─▶ CSV ─┐
//!                                                                         └─ figures::ALL ─▶ SVG ─┴─▶ report.html
//! ```
//!
//! Nothing here trains, predicts or reads a recording: what a page says, a record says.

mod agreement;
pub mod closed_loop;
pub mod error;
pub mod estimator;
pub mod figures;
mod json;
pub mod loop_config;
pub mod page;
pub mod predictions;
mod provenance;
pub mod recordings;
pub mod report;
pub mod run;
pub mod scoring;
pub mod section;
pub mod spread;
pub mod tables;
pub mod targets;
pub mod terminal;
pub mod unit;
