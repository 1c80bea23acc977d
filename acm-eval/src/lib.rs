//! Judging models: runs of acm-train from their records, and closing the loop with recordings.
//!
//! ```text
//! run folders ─ Run::read ─▶ runs ─ sections ─▶ one Section per data set ─┬─ tables::ALL  ─▶ CSV ─┐
//!                                                                         └─ figures::ALL ─▶ SVG ─┴─▶ report.html
//!
//! Asked ─▶ Question ─▶ recordings ─▶ acm_trace::close ─▶ Finding ─ LoopFolder ─▶ loop.json, model.json, loop.html, figures, tables
//!                                                    └─ network_table: acm_train::schedule::job, without and with the effect
//! sealed truths ─ scoring ─▶ Score
//! ```
//!
//! A page is drawn from records or from a finding alone: what it says, a file beside it says.

pub mod chapter;
pub mod closed_loop;
pub mod error;
pub mod figures;
mod json;
pub mod network_table;
pub mod ownership;
pub mod page;
pub mod question;
pub mod report;
pub mod run;
pub mod scoring;
pub mod section;
pub mod stream;
pub mod tables;
pub mod terminal;
pub mod unit;

pub use acm_train::run::evaluation::spread;
