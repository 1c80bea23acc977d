//! Learning what the nominal model misses: experiment files, training, folds, seeds, checkpoints, run records.
//!
//! ```text
//! experiment file ─┐
//! campaign ────────┴► plans ─► calibrations ─► residual ─► windows ─► fit ─► predictions ─► RunRecord
//!                     schedule run             run         run        learn  run            run
//! ```
//!
//! Six floors. A file imports from floors below its own, and within its floor without a circle; a test of this crate checks it.
//!
//! | floor        | what it knows                                                                         | its error         |
//! | ------------ | ------------------------------------------------------------------------------------- | ----------------- |
//! | [`cli`]      | the command line, exit codes                                                          | [`TrainError`]    |
//! | [`schedule`] | many runs: plans, the queue, Slurm, studies                                           | [`ScheduleError`] |
//! | [`run`]      | one run: data, nominal model, scores, the record                                      | [`RunError`]      |
//! | [`learn`]    | fitting one network or baseline to windows                                            | [`LearnError`]    |
//! | [`config`]   | what is asked: files, their values, their faults                                      | [`ConfigError`]   |
//! | [`store`]    | files on the disk: whole, hashed, locked                                              | [`StoreError`]    |
//!
//! Each error has those of the floors below in it. [`cli::conduct`] is the whole story; [`run::record`] is what it leaves behind.
//!
//! [`ScheduleError`]: schedule::ScheduleError
//! [`RunError`]: run::RunError
//! [`LearnError`]: learn::LearnError
//! [`ConfigError`]: config::ConfigError
//! [`StoreError`]: store::StoreError

pub mod cli;
pub mod config;
pub mod learn;
pub mod run;
pub mod schedule;
pub mod store;

pub use cli::{TrainError, explain};
