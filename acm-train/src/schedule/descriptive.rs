//! Descriptive studies, without training: accuracy of the nominal model, and its residual.
//!
//! ```text
//! study file ─► base experiment ─► campaign ─► calibrations ─► errors by component, trial, group ─► study.json
//!                 base                                           rms, bins, sweep                   predictions/*.parquet
//! ```
//!
//! A study names the experiment whose data, domain filter and `[nominal]` it is about. Every number in `study.json` can
//! be computed again from the tables beside it.

pub mod base;
pub mod bins;
pub mod folder;
pub mod nominal;
pub mod residual;
pub mod rms;
pub mod show;
pub mod sweep;
