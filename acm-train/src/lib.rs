//! Learning what the nominal model misses: experiment files, training, folds, seeds, checkpoints, run records.
//!
//! ```text
//! experiment file ─┐
//! campaign ────────┴► plans ─► calibrations ─► residual ─► windows ─► fit ─► predictions ─► RunRecord
//!                     plan     nominal         prepare               learn   run            record
//! ```
//!
//! [`job::conduct`] is the whole story; [`record`] is what it leaves behind.

pub mod atomic;
pub mod augmented;
pub mod baseline;
pub mod bounded;
pub mod cli;
pub mod data;
pub mod descriptive;
pub mod engine;
pub mod error;
pub mod experiment;
pub mod floors;
pub mod folder;
pub mod hashed;
pub mod held_out;
pub mod job;
pub mod learn;
pub mod names;
pub mod nominal;
pub mod open;
pub mod plan;
pub mod predictions;
pub mod prepare;
pub mod progress;
pub mod queue;
pub mod range;
pub mod ready;
pub mod record;
pub mod run;
pub mod score;
pub mod scored;
pub mod sequences;
pub mod shuffle;
pub mod slurm;
pub mod spread;
pub mod stop;
pub mod study;
pub mod summary;
pub mod training_log;
pub mod versions;
