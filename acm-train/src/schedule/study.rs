//! Studies: files that ask for more than one experiment. Their key `study` says which kind they are.
//!
//! | `study`      | asks                                                                 | answered by             |
//! | ------------ | -------------------------------------------------------------------- | ----------------------- |
//! | `sweep`      | which of many settings has the smallest validation error             | [`lists`]               |
//! | `ablation`   | by how much errors grow, change by change                            | [`lists`]               |
//! | `comparison` | which of several models errs least, under one protocol or several    | [`lists`]               |
//! | `inputs`     | which inputs are worth having                                        | [`lists`]               |
//! | `best`       | which model is to be used: nominal, networks, baselines, averages    | [`best`]                |
//! | `nominal`    | how many strain orders, and how well the nominal model is calibrated | [`nominal`]             |
//! | `residual`   | what the nominal model misses in flight                              | [`residual`]            |
//! | `sequences`  | what elapsed time tells of sequences that are no trials              | [`sequences`]           |
//!
//! The first four ask experiments, or questions about sequences ([`of_sequences`]).
//! Each of the first three is a list of edits to experiments ([`list`]); the fourth makes its own ([`inputs`]); the fifth compares its experiments
//! under the folds and trains the winner alone to the end; the next two train nothing.

mod batch;
pub mod best;
pub mod eliminate;
pub mod fold_errors;
pub mod inputs;
mod label;
pub mod list;
mod lists;
pub mod of_sequences;
pub mod paired;
pub mod record;
mod sequence_table;
pub mod steps;
pub mod sweep;
pub mod table;

use super::{
    descriptive::{nominal, residual},
    error::ScheduleError,
    request::{Engine, Request},
    sequences,
};
use crate::config::{Kind, Source};

/// Runs a study, and returns the text to print.
///
/// # Errors
/// Anything in [`ScheduleError`]; what is finished is kept.
pub fn conduct(kind: Kind, source: Source, request: &Request) -> Result<String, ScheduleError> {
    if let (Kind::Nominal | Kind::Residual, Engine::Slurm(_) | Engine::Kubernetes(..)) = (kind, request.engine) {
        return Err(ScheduleError::Usage {
            what: "this study trains nothing, so there is nothing to submit".into(),
            help: "leave --engine out: it takes seconds".into(),
        });
    }
    match kind {
        Kind::Sweep | Kind::Ablation | Kind::Comparison | Kind::Inputs => lists::conduct(kind, &source, request),
        Kind::Best => best::conduct(&source, request),
        Kind::Nominal => nominal::conduct(&source, request),
        Kind::Residual => residual::conduct(&source, request),
        Kind::Sequences => sequences::conduct(source, request),
    }
}
