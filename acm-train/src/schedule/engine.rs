//! Engines that compute the runs: this process, the tasks of job arrays, or the pods of a Job. All take them from one
//! list ([`crate::schedule::open`]), and the results of the records are computed here in any case.

pub mod answer;
pub mod kubernetes;
pub mod queue;
pub mod slurm;

use super::error::ScheduleError;
use super::open::{self, Planned};
use super::ready::Ready;
use super::request::{Engine, Request};
use crate::{run::record::RunRecord, store::RunFolder};
use answer::Answer;
use kubernetes::write::write;
use slurm::bring::bring;

/// Runs some experiments until they have their records, in the order of the plans.
///
/// # Errors
/// A run fails, Slurm refuses, or the user stops it; finished runs are kept.
pub fn run(
    experiments: &[Ready],
    folders: &[RunFolder],
    request: &Request,
) -> Result<Answer<Vec<Vec<RunRecord>>>, ScheduleError> {
    let planned = open::planned(experiments, folders, request.out);
    if let Answer::Waiting(text) = elsewhere(&planned, request)? {
        return Ok(Answer::Waiting(text));
    }
    if request.engine.only_looks() {
        let records = open::records(experiments, folders)?;
        return Ok(Answer::Finished(records.into_iter().map(|of| of.into_iter().flatten().collect()).collect()));
    }
    queue::run(experiments, folders, request).map(Answer::Finished)
}

/// Submits open runs to another engine, where the request names one.
///
/// # Errors
/// Slurm refuses, a manifest cannot be written, or the user stops it.
pub fn elsewhere(planned: &Planned, request: &Request) -> Result<Answer<()>, ScheduleError> {
    match request.engine {
        Engine::Slurm(slurm) => bring(slurm, planned, request),
        Engine::Kubernetes(options, limits) if !planned.open().is_empty() => {
            write(options, limits, planned, request).map(Answer::Waiting)
        }
        Engine::Local | Engine::Kubernetes(..) => Ok(Answer::Finished(())),
    }
}
