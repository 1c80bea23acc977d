//! Waiting for all runs: the folder is polled, and failed runs are submitted again.

use std::{thread, time::Duration};

use super::{asked::Slurm, commands::SlurmError, round::round};
use crate::schedule::{error::ScheduleError, open::Planned, request::Request};

/// Pause between two queries of Slurm; it grows up to a limit.
const FIRST: Duration = Duration::from_millis(500);
const LONGEST: Duration = Duration::from_secs(10);
/// Pause between two checks of the folder.
const LOOK: Duration = Duration::from_millis(250);

/// Waits until every run has its record.
///
/// # Errors
/// A run has failed too often, Slurm refuses, or the user stops it; what is queued goes on all the same.
pub fn wait(slurm: &Slurm, planned: &Planned, request: &Request) -> Result<(), ScheduleError> {
    let all = planned.runs.len();
    let bar = request.progress.whole(all);
    let (mut told, mut silent, mut stuck, mut pause) = (usize::MAX, false, None, FIRST);
    loop {
        match round(slurm, planned, request) {
            Ok(round) => {
                silent = false;
                for (_, job, runs) in &round.submitted {
                    request.progress.note(&format!("{runs} of {all} runs are submitted as job {job}"));
                }
                let now = round.stuck();
                now.iter().filter(|_| now != stuck).for_each(|line| request.progress.note(line));
                stuck = now;
            }
            Err(ScheduleError::Slurm(error @ SlurmError::Silent { .. })) => {
                if !silent {
                    request.progress.note(&format!("{error}; waiting"));
                }
                silent = true;
            }
            // What the last tasks wrote may have come between the look and the question.
            Err(_) if planned.open().is_empty() => {}
            Err(error) => return Err(error),
        }
        for _ in 0..(pause.as_millis() / LOOK.as_millis()).max(1) {
            let done = all - planned.unfinished();
            if let Some(bar) = &bar {
                bar.set_position(done as u64);
            } else if told == usize::MAX || 10 * done / all != 10 * told / all {
                request.progress.note(&format!("{done} of {all} runs are done"));
                told = done;
            }
            if done == all {
                return Ok(());
            }
            if request.stop.asked() {
                request.progress.note("what is queued goes on; scancel ends it");
                return Err(ScheduleError::Stopped { folder: request.out.into(), finished: done, planned: all });
            }
            thread::sleep(LOOK);
        }
        pause = LONGEST.min(pause * 3 / 2);
    }
}
