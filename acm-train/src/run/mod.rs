//! One run and its record: the data, the nominal model and a network, from a plan to a table of predictions.

pub mod data;
mod error;
pub mod evaluation;
pub mod import;
pub mod names;
pub mod nominal;
pub mod plan;
pub mod progress;
pub mod record;
pub mod sequences;
pub mod setting;
pub mod stop;
pub mod train;
pub mod trained;

pub use error::RunError;
