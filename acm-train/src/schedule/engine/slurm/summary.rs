//! Result of a round, and its message.

use super::{commands::SlurmError, folder::SlurmFolder, submissions::Spent};
use crate::run::evaluation::summary::count;

/// Number of names of runs and tasks in one message.
const SHOWN: usize = 5;

/// Result of a round.
#[derive(Debug)]
pub struct Round {
    pub(super) folder: SlurmFolder,
    pub(super) planned: usize,
    pub(super) open: usize,
    /// Runs that Slurm has not ended, or that a process works on.
    pub(super) waiting: usize,
    /// Tasks that need a user's action: names and reasons.
    pub(super) held: Vec<String>,
    /// Runs that are left alone.
    pub(super) spent: Vec<Spent>,
    /// Arrays that were submitted: their names, their jobs and their sizes.
    pub submitted: Vec<(String, String, usize)>,
    /// Refusal of sbatch, if there was one.
    pub(super) refusal: Option<SlurmError>,
    pub(super) collector: Option<String>,
    /// Scripts of a dry run.
    pub(super) scripts: Vec<String>,
}

impl Round {
    /// Returns the error for the case that all open runs were begun too often.
    pub(super) fn give_up(&self) -> SlurmError {
        let list: Vec<&str> = self.spent.iter().map(|spent| spent.what.as_str()).take(SHOWN).collect();
        let rest = self.spent.len() - list.len();
        let more = if rest > 0 { format!("\nand {rest} more") } else { String::new() };
        let (done, planned, list) = (self.planned - self.open, self.planned, list.join("\n"));
        SlurmError::Spent {
            what: format!("{done} of {planned} runs are done; the others are left alone:\n{list}{more}"),
            code: self.spent.first().map_or(4, |spent| spent.code),
        }
    }

    /// Runs that need a user's action.
    pub fn stuck(&self) -> Option<String> {
        let refused = self.refusal.as_ref().map(|refusal| format!("the rest follows, since {refusal}"));
        let tasks = self.held.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
        let more = if self.held.len() > SHOWN { ", …" } else { "" };
        let held = (!self.held.is_empty()).then(|| {
            let count = count(self.held.len(), "task");
            format!(
                "{count} held by Slurm: {tasks}{more}; scontrol release lets them go, and what scancel ends is submitted again"
            )
        });
        let lines: Vec<String> = refused.into_iter().chain(held).collect();
        (!lines.is_empty()).then(|| lines.join("\n"))
    }

    /// Writes the summary for people.
    pub fn text(&self) -> String {
        let lines = std::iter::once(self.counts())
            .chain(self.spent.iter().take(SHOWN).map(|spent| spent.what.clone()))
            .chain(self.stuck());
        match self.scripts.is_empty() {
            false => self.scripts.iter().cloned().chain(lines).collect::<Vec<_>>().join("\n"),
            true => lines.chain(self.remains()).collect::<Vec<_>>().join("\n"),
        }
    }

    fn counts(&self) -> String {
        let new: usize = self.submitted.iter().map(|(.., runs)| runs).sum();
        let jobs: Vec<&str> = self.submitted.iter().map(|(_, job, _)| job.as_str()).collect();
        let mut parts = vec![format!("{} done", self.planned - self.open)];
        parts.extend((self.waiting > 0).then(|| format!("{} queued or at work", self.waiting)));
        parts.extend((new > 0).then(|| match self.scripts.is_empty() {
            true => format!("{new} submitted as job {}", jobs.join(", ")),
            false => format!("{new} to be submitted in {}", count(jobs.len(), "array")),
        }));
        parts.extend((!self.spent.is_empty()).then(|| format!("{} left alone", self.spent.len())));
        format!("{}: {}", count(self.planned, "run"), parts.join(", "))
    }

    fn remains(&self) -> [String; 2] {
        let logs = self.folder.path("logs");
        let next = match &self.collector {
            Some(job) => {
                let log = logs.join("collector.log");
                format!("job {job} submits what is missing by then, or writes the tables into {}", log.display())
            }
            None => "the same command submits what is missing by then, or prints the tables".into(),
        };
        let names: Vec<&str> = self.submitted.iter().map(|(name, ..)| name.as_str()).collect();
        let queue = if names.is_empty() { String::new() } else { format!("; squeue --name={}", names.join(",")) };
        [next, format!("what the runs say: {}{queue}", logs.display())]
    }
}
