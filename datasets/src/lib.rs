//! Recordings of a robot: trials, checks, windows, folds, scalers, and simulated rigs as data sets.
//!
//! ```text
//! manifest.toml + CSV or Parquet → Campaign (checked, SI) → domain filter → Series → windows, standardizer
//! ```
//!
//! [`Recordings::open`] is the door: it finds the files, checks them, and says everything that is wrong at once; trials
//! are then read one by one. [`Campaign::read`] goes through it and holds all of them. Only this crate reads recordings.

pub mod atomic;
mod campaign;
mod channel;
mod consistency;
mod cut;
pub mod describe;
mod domain;
mod entry;
mod error;
pub mod folds;
pub mod formats;
pub mod generate;
pub mod help;
mod hull;
pub mod init;
pub mod join;
mod layout;
pub mod levels;
pub mod limits;
pub mod locate;
pub mod lock;
pub mod manifest;
mod natural;
mod plausible;
pub mod predict;
mod recording;
pub mod recordings;
pub mod rig;
mod rows;
mod segments;
pub mod sequences;
mod series;
pub mod sources;
pub mod spelling;
mod split;
mod standardizer;
mod stream;
mod suspect;
pub mod table;
pub mod terminal;
pub mod toml_file;
pub mod toml_words;
mod trial;
pub mod units;
mod windows;

pub use campaign::Campaign;
pub use channel::{Channel, UnknownChannel, default_channels, rate};
pub use domain::{Domain, DomainFilter, domain_filter};
pub use entry::Entry;
pub use error::{DataError, More, Problems};
pub use manifest::{Manifest, Role};
pub use recordings::Recordings;
pub use segments::{median_step, segments};
pub use series::{Series, series};
pub use standardizer::{Means, Spreads, Standardizer};
pub use trial::{DropReason, Trial};
pub use windows::{Window, WindowSpec, windows, windows_of};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
