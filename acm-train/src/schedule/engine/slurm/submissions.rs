//! Earlier submissions, and the status of each open run.

use std::collections::{BTreeMap, BTreeSet};

use super::array::digest::digest;
use super::array::list::Entry;
use super::commands::{self, Queued};
use super::folder::SlurmFolder;
use super::tries::Tries;
use crate::schedule::{
    error::ScheduleError,
    open::{Planned, Run},
};

/// Arrays and runs that were submitted for a folder.
pub struct Submissions {
    /// The first number that no list has.
    pub next: usize,
    /// Arrays and collectors that Slurm has not ended.
    pub queued: Vec<Queued>,
    /// Runs that are among these.
    waiting: BTreeSet<String>,
    of: BTreeMap<String, Vec<Submission>>,
}

/// One time that a run was submitted.
struct Submission {
    number: usize,
    index: usize,
    checkpoint: Option<String>,
    accepted: bool,
}

/// Status of an open run.
pub enum Standing {
    /// No process or task works on the run.
    Missing(Entry),
    /// Slurm has not ended the run, or a process works on it.
    Waiting,
    /// The run was begun too often.
    Spent(Spent),
}

/// A run that was begun too often.
#[derive(Debug)]
pub struct Spent {
    /// Name of the run, number of attempts, last message, and place of the logs.
    pub what: String,
    /// Exit code of the last attempt, where known.
    pub code: u8,
}

impl Submissions {
    /// Reads the lists, and queries Slurm for the unfinished jobs of those with open runs; no query where there are
    /// none.
    ///
    /// # Errors
    /// A list cannot be read; Slurm is missing or does not answer.
    pub fn read(folder: &SlurmFolder, planned: &Planned) -> Result<Self, ScheduleError> {
        let lists = folder.lists()?;
        let ids: BTreeSet<&str> = planned.open().iter().map(|run| run.id.as_str()).collect();
        let next = lists.last().map_or(1, |(last, _)| last + 1);
        let (mut of, mut names): (BTreeMap<String, Vec<Submission>>, BTreeMap<String, usize>) = Default::default();
        for (place, (number, list)) in lists.iter().enumerate() {
            let accepted = folder.of(*number, "job").exists();
            for (index, run) in list.runs.iter().enumerate().filter(|(_, run)| ids.contains(run.id.as_str())) {
                let (number, checkpoint) = (*number, run.checkpoint.clone());
                of.entry(run.id.clone()).or_default().push(Submission { number, index, checkpoint, accepted });
                names.insert(folder.job_name(number), place);
            }
        }
        let asked: Vec<String> = names.keys().cloned().chain([folder.collector_name()]).collect();
        let queued = if names.is_empty() { vec![] } else { commands::queued(&asked)? };
        let run = |job: &Queued| Some(lists[*names.get(&job.name)?].1.runs.get(job.index?)?.id.clone());
        let waiting = queued.iter().filter_map(run).collect();
        Ok(Self { next, queued, waiting, of })
    }

    /// Returns the status of a run that may be begun `cap` times from the same epoch.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn standing(&self, folder: &SlurmFolder, cap: usize, run: &Run) -> Result<Standing, ScheduleError> {
        if self.waiting.contains(&run.id) || folder.at_work(&run.id) {
            return Ok(Standing::Waiting);
        }
        let checkpoint = digest(&run.checkpoint)?;
        let begun = Tries::read(folder, &run.id)?;
        let submissions = self.of.get(&run.id).map_or(&[][..], Vec::as_slice);
        // A task that could not even start its program has noted nothing.
        let submitted = submissions.iter().filter(|one| one.accepted && one.checkpoint == checkpoint).count();
        let often = begun.from(&checkpoint).max(submitted);
        if often < cap {
            let (id, asked, plan) = (run.id.clone(), run.asked, run.plan.clone());
            return Ok(Standing::Missing(Entry { id, asked, plan, checkpoint }));
        }
        let end = begun.tries.last().and_then(|last| last.end.as_ref());
        let said = end.map_or("it was killed, or could not start", |end| end.said.as_str());
        let log = submissions.last().map(|last| folder.log(last.number, last.index).display().to_string());
        let times = if often == 1 { "once".into() } else { format!("{often} times") };
        let what = format!("{} was begun {times} from the same epoch: {said}\n  {}", run.id, log.unwrap_or_default());
        Ok(Standing::Spent(Spent { what, code: end.map_or(4, |end| end.code) }))
    }
}
