//! Trains networks on the residual of a nominal model: experiment files, folds, seeds, checkpoints, run records.
//!
//! ```text
//! experiment file ─┐
//! campaign ────────┴► plans ─► calibrations ─► residual ─► windows ─► fit ─► predictions ─► RunRecord
//!                     schedule run             run         run        learn  run            run
//! ```
//!
//! Six layers. A file imports only from lower layers, and from its own layer without cycles; `cargo xtask structure` checks it.
//!
//! | layer        | task                                                                                  | error             |
//! | ------------ | ------------------------------------------------------------------------------------- | ----------------- |
//! | [`cli`]      | the command line, exit codes                                                          | [`TrainError`]    |
//! | [`schedule`] | many runs: plans, the queue, Slurm, Kubernetes, studies                               | [`ScheduleError`] |
//! | [`run`]      | one run: data, nominal model, scores, the record                                      | [`RunError`]      |
//! | [`learn`]    | fitting one network or baseline to windows                                            | [`LearnError`]    |
//! | [`config`]   | configuration files: values, defaults, errors with line and column                    | [`ConfigError`]   |
//! | [`store`]    | files on disk: atomic, hashed, locked                                                 | [`StoreError`]    |
//!
//! Each error includes those of the layers below. Begin with [`cli::conduct`], which runs a job, and [`run::record`], which
//! describes what a job writes.
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
