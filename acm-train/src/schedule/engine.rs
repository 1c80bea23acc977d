//! Who computes the runs: this process, or the tasks of job arrays. Both take them from one list ([`crate::schedule::open`]), and
//! what follows from the records is computed here either way.

use super::{
    answer::Answer,
    error::ScheduleError,
    open, queue,
    ready::Ready,
    request::{Engine, Request},
    slurm::bring::bring,
};
use crate::{run::record::RunRecord, store::RunFolder};

/// Brings the runs of some experiments to their records, in the order of the plans.
///
/// # Errors
/// A run fails, Slurm refuses, or somebody asks to stop; finished runs are kept.
pub fn run(
    experiments: &[Ready],
    folders: &[RunFolder],
    request: &Request,
) -> Result<Answer<Vec<Vec<RunRecord>>>, ScheduleError> {
    let planned = open::planned(experiments, folders, request.out);
    if let Engine::Slurm(slurm) = request.engine
        && let Answer::Waiting(text) = bring(slurm, &planned, request)?
    {
        return Ok(Answer::Waiting(text));
    }
    if request.engine.only_looks() {
        let records = open::records(experiments, folders)?;
        return Ok(Answer::Finished(records.into_iter().map(|of| of.into_iter().flatten().collect()).collect()));
    }
    queue::run(experiments, folders, request).map(Answer::Finished)
}
