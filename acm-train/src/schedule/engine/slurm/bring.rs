//! Runs open runs on Slurm.

use super::{asked::Slurm, round, wait};
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::open::Planned;
use crate::schedule::request::Request;

/// Submits open runs to Slurm. It returns at once, or waits for the runs where that is requested.
///
/// # Errors
/// Slurm is missing, refuses or does not answer; a run has failed too often; the user stops it.
pub fn bring(slurm: &Slurm, planned: &Planned, request: &Request) -> Result<Answer<()>, ScheduleError> {
    if planned.open().is_empty() {
        return Ok(Answer::Finished(()));
    }
    if slurm.options.wait && !slurm.options.dry_run {
        return wait::wait(slurm, planned, request).map(Answer::Finished);
    }
    round::round(slurm, planned, request).map(|round| Answer::Waiting(round.text()))
}
