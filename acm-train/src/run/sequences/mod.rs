//! Sequences without trials: benchmarks of irregular sampling, with labels or numbers as targets.
//!
//! ```text
//! file ─► Question ─► SequenceSet ─► a network for each row and seed ─► test part, once ─► SequenceRecord ─► table
//!         config      acm-datasets   learn::fit, train                                     record           table
//! ```
//!
//! There is no nominal model and no campaign. A question has one row, or two where a `[control]` asks the same network
//! again with other news of time. The run folder is that of an experiment (`experiment.toml`, `records/`, `predictions/`,
//! `checkpoints/`), and has a `study.json` in the place of `nominal.json`.

pub mod constant;
pub mod plan;
pub mod record;
pub mod scores;
pub mod table;
pub mod together;
pub mod train;
pub mod units;

pub use together::together;
