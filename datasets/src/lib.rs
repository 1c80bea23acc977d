//! Recordings of a robot: trials, checks, windows, folds, scalers, and simulated rigs as data sets.
//!
//! ```text
//! manifest.toml + CSV or Parquet → Campaign (checked, SI) → domain filter → Series → windows, standardizer
//! ```
//!
//! [`Recordings::open`] is the door: it finds the files, checks them, and says everything that is wrong at once; trials
//! are then read one by one. [`Campaign::read`] goes through it and holds all of them. Only this crate reads recordings.

mod campaign;
mod checks;
pub mod describe;
mod entry;
mod error;
pub mod files;
pub mod folds;
pub mod formats;
pub mod generate;
pub mod ingest;
pub mod init;
pub mod join;
pub mod levels;
pub mod manifest;
pub mod predict;
mod preprocessing;
pub mod recordings;
pub mod rig;
pub mod sequences;
pub mod text;
pub mod toml_file;
mod trial;
pub mod units;

pub use campaign::Campaign;
pub use entry::Entry;
pub use error::{DataError, More, Problems};
pub use manifest::{Manifest, Role};
pub use preprocessing::channel::{Channel, UnknownChannel, default_channels, default_rates, rate};
pub use preprocessing::domain::{Domain, DomainFilter, domain_filter};
pub use preprocessing::segments::{max_gap, median_step, segments, usual_step};
pub use preprocessing::series::{Series, series};
pub use preprocessing::standardizer::{Means, Spreads, Standardizer};
pub use preprocessing::windows::{Window, WindowSpec, windows, windows_of};
pub use recordings::Recordings;
pub use trial::{DropReason, Trial};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
