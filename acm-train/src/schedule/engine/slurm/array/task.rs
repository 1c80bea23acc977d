//! A task of an array: one run, from its checkpoint if any, to its record.

use std::{env, num::NonZeroUsize, path::Path};

use super::digest::digest;
use super::list::{Entry, List};
use crate::config::Source;
use crate::run::progress::Progress;
use crate::run::record::read_nominal;
use crate::run::stop::Stop;
use crate::schedule::engine::queue;
use crate::schedule::engine::slurm::folder::SlurmFolder;
use crate::schedule::engine::slurm::tries::{End, Tries, Try};
use crate::schedule::error::ScheduleError;
use crate::schedule::open::{Asked, What};
use crate::schedule::ready::{Campaigns, Ready};
use crate::schedule::request::Request;
use crate::schedule::sequences;
use crate::store::{Hold, RunFolder, StoreError, StudyFolder};

/// Computes the run of this task of the array, and returns a message about its outcome.
///
/// # Errors
/// There is no such run, a local process holds the whole folder, or the run fails; the failure is noted beside the run.
pub fn conduct(
    file: &Path,
    threads: Option<NonZeroUsize>,
    progress: &Progress,
    stop: &Stop,
) -> Result<String, ScheduleError> {
    let file = std::path::absolute(file).map_err(|source| StoreError::io("find", file, source))?;
    let list = List::read(&file)?;
    let (Some(folder), (entry, asked)) = (SlurmFolder::of_list(&file), entry(&list, &file)?) else {
        return Err(ScheduleError::Usage {
            what: format!("{} is not in the folder slurm/ or kubernetes/ of a folder of runs", file.display()),
            help: "give the path that acm-train wrote".into(),
        });
    };
    let root = folder.root.join(&asked.folder);
    let whole = (!asked.folder.as_os_str().is_empty()).then(|| StudyFolder::hold(&folder.root, Hold::Shared));
    let _whole = whole.transpose()?;
    let runs = RunFolder::hold(&root, Hold::Shared)?;
    let Some(_mine) = folder.run(&entry.id)? else {
        return Ok(format!("{}: another task works on it, and this one ends", entry.id));
    };
    if runs.record(&entry.plan).exists() {
        return Ok(format!("{} has its record already", entry.id));
    }
    let request = Request {
        data: list.data.as_deref(),
        resume: true,
        jobs: Some(NonZeroUsize::MIN),
        threads,
        ..Request::new(&root, progress, stop)
    };
    let mut tries = begin(&folder, &list, entry, &runs)?;
    let ended = work(entry, asked, &runs, &request);
    let end = match &ended {
        Ok(()) => End { code: 0, said: "done".into() },
        Err(error) => End { code: error.exit_code(), said: error.to_string() },
    };
    if let Some(last) = tries.tries.last_mut() {
        last.end = Some(end);
    }
    tries.write(&folder, &entry.id)?;
    ended.map(|()| format!("{} is done", entry.id))
}

/// Returns the run with the index of this task.
fn entry<'l>(list: &'l List, file: &Path) -> Result<(&'l Entry, &'l Asked), ScheduleError> {
    let [slurm, kubernetes] = ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"].map(|name| env::var(name).ok());
    let index = slurm.or(kubernetes).unwrap_or_default();
    let entry = index.parse().ok().and_then(|index: usize| list.runs.get(index));
    entry.and_then(|entry| Some((entry, list.asked.get(entry.asked)?))).ok_or_else(|| ScheduleError::Usage {
        what: format!(
            "SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX is {index:?}, and {} has runs 0 to {}",
            file.display(),
            list.runs.len().saturating_sub(1)
        ),
        help: "--task is what a job array or an Indexed Job calls; see --engine slurm and --engine kubernetes".into(),
    })
}

/// Records the attempt. Slurm itself may start a task again, so the limit holds here too.
fn begin(folder: &SlurmFolder, list: &List, entry: &Entry, runs: &RunFolder) -> Result<Tries, ScheduleError> {
    let checkpoint = digest(&runs.checkpoint(&entry.plan))?;
    let mut tries = Tries::read(folder, &entry.id)?;
    let often = tries.from(&checkpoint);
    if often >= list.attempts {
        return Err(ScheduleError::Usage {
            what: format!("{} was begun {often} times from the same epoch, and is left alone", entry.id),
            help: "read its logs, mend the cause, then submit it again with --attempts N".into(),
        });
    }
    let named = |name: &str| env::var(name).ok();
    let array = named("SLURM_ARRAY_JOB_ID").unwrap_or_default();
    let task = format!("{array}_{}", named("SLURM_ARRAY_TASK_ID").unwrap_or_default());
    tries.tries.push(Try { task, node: named("SLURMD_NODENAME"), checkpoint, end: None });
    tries.write(folder, &entry.id)?;
    Ok(tries)
}

fn work(entry: &Entry, asked: &Asked, folder: &RunFolder, request: &Request) -> Result<(), ScheduleError> {
    let source = Source::resolved(&asked.file);
    let finished = queue::within(request.threads.map_or(1, NonZeroUsize::get), || match &asked.what {
        What::Question(question) => sequences::one(question, &source, &entry.plan, folder, request),
        What::Experiment(experiment) => {
            let (nominal, mut campaigns) = (read_nominal(folder.root())?, Campaigns::default());
            let ready = Ready::calibrated(experiment.as_ref().clone(), &source, request, &mut campaigns, nominal)?;
            let plan = ready.plans.iter().find(|plan| plan.id == entry.plan).ok_or_else(|| gone(entry))?;
            queue::finish(&ready, plan, folder, &entry.id, request.progress, request.stop)
                .map(|record| record.is_some())
        }
    });
    match finished?? {
        true => Ok(()),
        false => Err(ScheduleError::Stopped { folder: request.out.into(), finished: 0, planned: 1 }),
    }
}

fn gone(entry: &Entry) -> ScheduleError {
    ScheduleError::Usage {
        what: format!("{} is not planned any more", entry.id),
        help: "the data or this program have changed since it was submitted; call acm-train again to plan it again"
            .into(),
    }
}
