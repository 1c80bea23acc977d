//! One run and its record: the data, the nominal model and a network, from a plan to a table of predictions.

mod adopt;
pub mod alone;
pub mod augmented;
pub mod data;
mod error;
pub mod floors;
pub mod held_out;
pub mod import;
pub mod intervals;
pub mod names;
pub mod nominal;
pub mod plan;
pub mod poses;
pub mod predictions;
pub mod prepare;
pub mod progress;
pub mod range;
pub mod record;
pub mod score;
pub mod scored;
pub mod sequences;
pub mod setting;
pub mod shuffle;
pub mod spread;
pub mod stop;
pub mod summary;
pub mod train;
pub mod training_log;
pub mod verdict;
pub mod versions;

pub use error::RunError;
