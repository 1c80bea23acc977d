//! One round: open runs that are neither queued nor running are submitted, with a collector after them.

use std::{collections::BTreeSet, env};

use super::array::list::Entry;
use super::array::script::{self, Place};
use super::array::submit;
use super::asked::Slurm;
use super::commands::{self, LARGEST_ARRAY};
use super::folder::SlurmFolder;
use super::submissions::{Standing, Submissions};
use super::summary::Round;
use crate::{
    schedule::{error::ScheduleError, open::Planned, request::Request},
    store::atomic,
};

/// Inputs of a round.
#[derive(Clone, Copy)]
struct Call<'a> {
    slurm: &'a Slurm,
    planned: &'a Planned,
    request: &'a Request<'a>,
    place: &'a Place,
    submissions: &'a Submissions,
}

/// Queries Slurm and submits, while no other call does.
///
/// # Errors
/// Slurm is missing, refuses or does not answer; all that is open was begun too often; the file system refuses.
pub fn round(slurm: &Slurm, planned: &Planned, request: &Request) -> Result<Round, ScheduleError> {
    let folder = SlurmFolder::new(request.out)?;
    let _planning = if slurm.options.dry_run { None } else { Some(folder.plan()?) };
    let submissions = Submissions::read(&folder, planned)?;
    // After Slurm was asked: what has ended in between is queued no more, and has its record.
    let open = planned.open();
    let mut round = Round::new(folder, planned.runs.len(), open.len());
    let mut missing = vec![];
    for run in open {
        match submissions.standing(&round.folder, slurm.options.cap(), run)? {
            Standing::Missing(entry) => missing.push(entry),
            Standing::Waiting => round.waiting += 1,
            Standing::Spent(spent) => round.spent.push(spent),
        }
    }
    if missing.is_empty() && round.waiting == 0 && !round.spent.is_empty() {
        return Err(round.give_up().into());
    }
    let held = submissions.queued.iter().filter_map(|job| Some((job, job.index?, job.held.as_ref()?)));
    round.held = held.map(|(job, index, why)| format!("{}_{index} ({why})", job.job)).collect();
    let call = Call { slurm, planned, request, place: &Place::new(slurm)?, submissions: &submissions };
    round.submit(&call, &missing)?;
    round.collect(&call)?;
    Ok(round)
}

impl Round {
    fn new(folder: SlurmFolder, planned: usize, open: usize) -> Self {
        Self {
            folder,
            planned,
            open,
            waiting: 0,
            held: vec![],
            spent: vec![],
            submitted: vec![],
            refusal: None,
            collector: None,
            scripts: vec![],
        }
    }

    /// Submits arrays as large as Slurm takes. Where the number of simultaneous runs is limited, one array waits for
    /// the other.
    fn submit(&mut self, call: &Call, missing: &[Entry]) -> Result<(), ScheduleError> {
        if missing.is_empty() {
            return Ok(());
        }
        let options = &call.slurm.options;
        let largest = match commands::largest_array() {
            Err(_) if options.dry_run => LARGEST_ARRAY,
            other => other?,
        };
        let mut after: Vec<String> = vec![];
        for (number, runs) in (call.submissions.next..).zip(missing.chunks(largest.max(1))) {
            let text = script::array(call.slurm, call.place, &self.folder, number, runs.len(), &after)?;
            let list = submit::list(options.cap(), call.planned, call.request, runs)?;
            let name = self.folder.job_name(number);
            let job = match options.dry_run {
                true => {
                    self.scripts.push(text);
                    format!("<job of {number:04}>")
                }
                false => match submit::submit(&self.folder, number, &list, &text) {
                    Ok(job) => job,
                    // It has taken some, and takes the rest when these are done.
                    Err(ScheduleError::Slurm(refusal)) if self.waiting > 0 || !self.submitted.is_empty() => {
                        self.refusal = Some(refusal);
                        return Ok(());
                    }
                    Err(error) => return Err(error),
                },
            };
            if options.array_limit.is_some() {
                after = vec![job.clone()];
            }
            self.submitted.push((name, job, runs.len()));
        }
        Ok(())
    }

    /// Submits a collector after all queued jobs, unless there is one already, or the caller stays.
    fn collect(&mut self, call: &Call) -> Result<(), ScheduleError> {
        let queued = call.submissions.queued.iter();
        let mut jobs: BTreeSet<&String> = queued.filter(|job| job.index.is_some()).map(|job| &job.job).collect();
        jobs.extend(self.submitted.iter().map(|(_, job, _)| job));
        if call.slurm.options.wait || jobs.is_empty() {
            return Ok(());
        }
        let (name, own) = (self.folder.collector_name(), env::var("SLURM_JOB_ID").ok());
        let mut queued = call.submissions.queued.iter();
        if let Some(other) = queued.find(|job| job.name == name && Some(&job.job) != own.as_ref()) {
            self.collector = Some(other.job.clone());
            return Ok(());
        }
        let jobs: Vec<String> = jobs.into_iter().cloned().collect();
        let text = script::collector(call.slurm, call.place, &self.folder, &jobs)?;
        if call.slurm.options.dry_run {
            self.scripts.push(text);
            return Ok(());
        }
        let file = self.folder.path("collector.sh");
        atomic::write(&file, text.as_bytes())?;
        match commands::submit(&file) {
            Ok(job) => self.collector = Some(job),
            // The runs are queued all the same.
            Err(refusal) => self.refusal = Some(refusal),
        }
        Ok(())
    }
}
