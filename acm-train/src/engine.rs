//! Who computes the runs: this process, or the tasks of job arrays. Both take them from one list ([`crate::open`]), and
//! what follows from the records is computed here either way.

use crate::{
    error::TrainError, folder::RunFolder, job::Request, open, queue, ready::Ready, record::RunRecord, slurm::Slurm,
    summary::count,
};

/// Who computes the runs.
#[derive(Debug, Clone)]
pub enum Engine {
    /// This process, some at a time.
    Local,
    /// Tasks of Slurm's job arrays, one run each.
    Slurm(Slurm),
}

/// How far the runs have come.
#[derive(Debug)]
pub enum Answer<T> {
    /// All are there.
    Finished(T),
    /// Others are at work; the text says how far they are and what to do.
    Waiting(String),
}

impl Engine {
    /// Whether nothing is to be written: a dry run.
    pub fn only_looks(&self) -> bool {
        matches!(self, Self::Slurm(slurm) if slurm.options.dry_run)
    }
}

/// What a dry run says in the end.
pub fn nothing_to_submit(runs: usize) -> String {
    format!("{}: all done, nothing to submit; without --dry-run this prints the tables", count(runs, "run"))
}

/// Brings the runs of some experiments to their records, in the order of the plans.
///
/// # Errors
/// A run fails, Slurm refuses, or somebody asks to stop; finished runs are kept.
pub fn run(
    experiments: &[Ready],
    folders: &[RunFolder],
    request: &Request,
) -> Result<Answer<Vec<Vec<RunRecord>>>, TrainError> {
    let planned = open::planned(experiments, folders, request.out);
    if let Engine::Slurm(slurm) = request.engine
        && let Answer::Waiting(text) = slurm.bring(&planned, request)?
    {
        return Ok(Answer::Waiting(text));
    }
    if request.engine.only_looks() {
        return open::records(experiments, folders).map(|of| {
            Answer::Finished(of.into_iter().map(|records| records.into_iter().flatten().collect()).collect())
        });
    }
    queue::run(experiments, folders, request).map(Answer::Finished)
}
