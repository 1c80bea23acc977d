//! The runs of one experiment or of many, side by side.
//!
//! Runs are independent: each is computed by its own rule from its own seed, and its record is written as soon as it is
//! done. The order of records and logs is that of the plans, whoever was ready first.

use std::{
    num::NonZeroUsize,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use indicatif::ProgressBar;

use crate::run::evaluation::{intervals, verdict};
use crate::run::nominal::poses;
use crate::run::plan::Plan;
use crate::run::progress::Progress;
use crate::run::record::{RunRecord, training_log};
use crate::run::stop::Stop;
use crate::run::train::{Outcome, train};
use crate::schedule::error::ScheduleError;
use crate::schedule::open;
use crate::schedule::ready::Ready;
use crate::schedule::request::Request;
use crate::store::{RunFolder, StoreError, atomic, hashed};

/// Largest number of runs that are shown in progress; of more, only the ends are shown.
const MANY: usize = 12;

/// Runs what is not finished in the folder of each experiment, and returns its records in the order of its plans.
///
/// # Errors
/// A run fails, or somebody asks to stop; finished runs are kept, and unfinished ones are checkpointed.
pub fn run(
    experiments: &[Ready],
    folders: &[RunFolder],
    request: &Request,
) -> Result<Vec<Vec<RunRecord>>, ScheduleError> {
    let records = open::records(experiments, folders)?;
    let open: Vec<(usize, usize)> = (records.iter().enumerate())
        .flat_map(|(e, of)| of.iter().enumerate().filter(|(_, record)| record.is_none()).map(move |(p, _)| (e, p)))
        .collect();
    let many = open.len() > MANY;
    let progress = if many { request.progress.of_many() } else { request.progress.clone() };
    let whole = if many { progress.whole(open.len()) } else { None };
    let queue = Queue { experiments, folders, open, request, progress, whole, records: Mutex::new(records) };
    for follows in [false, true] {
        let of = |(e, p): &&(usize, usize)| experiments[*e].plans[*p].follows_folds() == follows;
        let open: Vec<(usize, usize)> = queue.open.iter().filter(of).copied().collect();
        side_by_side(open.len(), request, |next| queue.one(open[next]))?;
    }
    queue.outcome()
}

/// Does `work` for each of `0..count`, as many at the same time as the request says, each in a pool of its own threads.
/// A worker takes one after the other until there is none, the user stops the job, or one fails.
///
/// # Errors
/// The first failure; it asks the others to stop.
pub fn side_by_side(
    count: usize,
    request: &Request,
    work: impl Fn(usize) -> Result<(), ScheduleError> + Sync,
) -> Result<(), ScheduleError> {
    let cores = thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = request.jobs.map_or(cores, NonZeroUsize::get).min(count.max(1));
    let threads = request.threads.map_or((cores / jobs).max(1), NonZeroUsize::get);
    let (next, failure) = (AtomicUsize::new(0), Mutex::new(None));
    let worker = || {
        while !request.stop.asked() {
            let index = next.fetch_add(1, Ordering::SeqCst);
            if index >= count {
                return;
            }
            if let Err(error) = within(threads, || work(index)).flatten() {
                request.stop.ask();
                lock(&failure).get_or_insert(error);
            }
        }
    };
    thread::scope(|scope| (0..jobs).for_each(|_| drop(scope.spawn(worker))));
    lock(&failure).take().map_or(Ok(()), Err)
}

/// Computes one run and writes its record last; `None` where the user stopped it.
///
/// # Errors
/// The run fails.
pub(crate) fn finish(
    ready: &Ready,
    plan: &Plan,
    folder: &RunFolder,
    name: &str,
    progress: &Progress,
    stop: &Stop,
) -> Result<Option<RunRecord>, ScheduleError> {
    match train(&ready.setting(), plan, folder, name, progress, stop)? {
        Outcome::Stopped => Ok(None),
        Outcome::Finished(record) => {
            hashed::write(&folder.record(&plan.id), &record)?;
            Ok(Some(*record))
        }
    }
}

struct Queue<'a> {
    experiments: &'a [Ready],
    folders: &'a [RunFolder],
    /// Experiment and plan of each run that has no record yet.
    open: Vec<(usize, usize)>,
    request: &'a Request<'a>,
    progress: Progress,
    /// The bar over all runs.
    whole: Option<ProgressBar>,
    records: Mutex<Vec<Vec<Option<RunRecord>>>>,
}

impl Queue<'_> {
    fn one(&self, (experiment, index): (usize, usize)) -> Result<(), ScheduleError> {
        let (ready, folder) = (&self.experiments[experiment], &self.folders[experiment]);
        let plan = &ready.plans[index];
        let name = self.name(folder, plan);
        if let Some(record) = finish(ready, plan, folder, &name, &self.progress, self.request.stop)? {
            let mut records = lock(&self.records);
            records[experiment][index] = Some(record);
            log(ready, folder, records[experiment].iter().flatten())?;
            self.count(records.iter().flatten().flatten().count());
        }
        Ok(())
    }

    /// Shows the progress of all of them: the bar, or a line after each tenth.
    fn count(&self, finished: usize) {
        let (open, planned) = (self.open.len(), self.experiments.iter().map(|ready| ready.plans.len()).sum::<usize>());
        match &self.whole {
            Some(bar) => bar.set_position((finished + open - planned) as u64),
            None if open > MANY && 10 * finished / planned != 10 * (finished - 1) / planned => {
                self.progress.note(&format!("{finished} of {planned} runs are finished"));
            }
            None => {}
        }
    }

    /// Returns the name of a run in progress messages: with its experiment where there are several.
    fn name(&self, folder: &RunFolder, plan: &Plan) -> String {
        match (self.experiments.len(), folder.root().file_name()) {
            (1, _) | (_, None) => plan.id.clone(),
            (_, Some(name)) => format!("{} {}", name.to_string_lossy(), plan.id),
        }
    }

    fn outcome(self) -> Result<Vec<Vec<RunRecord>>, ScheduleError> {
        let records: Vec<Vec<RunRecord>> =
            lock(&self.records).drain(..).map(|of| of.into_iter().flatten().collect()).collect();
        let planned = self.experiments.iter().map(|ready| ready.plans.len()).sum();
        let finished = records.iter().map(Vec::len).sum();
        if finished < planned {
            return Err(ScheduleError::Stopped { folder: self.request.out.into(), finished, planned });
        }
        let all = self.experiments.iter().zip(self.folders).zip(&records);
        all.into_iter().try_for_each(|((ready, folder), records)| {
            log(ready, folder, records)?;
            judge(folder, records)?;
            // Runs of a study are compared and not drawn in space.
            if self.experiments.len() == 1 { pose(ready, folder, records) } else { Ok(()) }
        })?;
        Ok(records)
    }
}

fn log<'r>(
    ready: &Ready,
    folder: &RunFolder,
    records: impl IntoIterator<Item = &'r RunRecord>,
) -> Result<(), StoreError> {
    let finished: Vec<&RunRecord> = records.into_iter().collect();
    let text = training_log::text(&ready.nominal, &finished);
    atomic::write(&folder.path("training.log"), text.as_bytes())
}

/// Writes the verdict and the intervals, for other programs.
fn judge(folder: &RunFolder, records: &[RunRecord]) -> Result<(), ScheduleError> {
    let records: Vec<&RunRecord> = records.iter().collect();
    if let Some(verdict) = verdict::of(&records) {
        hashed::write(&folder.path("verdict.json"), &verdict)?;
    }
    if let Some(intervals) = intervals::of(&records, folder.root())? {
        hashed::write(&folder.path(intervals::FILE), &intervals)?;
    }
    Ok(())
}

/// Writes the poses of the nominal arm, for pages.
fn pose(ready: &Ready, folder: &RunFolder, records: &[RunRecord]) -> Result<(), ScheduleError> {
    let records: Vec<&RunRecord> = records.iter().collect();
    match poses::of(&ready.setting(), &ready.plans, &records, folder.root())? {
        Some(poses) => Ok(hashed::write(&folder.path(poses::FILE), &poses)?),
        None => Ok(()),
    }
}

/// Locks a mutex. A worker that panicked leaves its data unchanged.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs `work` with a pool of its own, so that runs side by side do not share threads.
pub(crate) fn within<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, ScheduleError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| ScheduleError::Usage {
        what: format!("cannot start {threads} threads: {error}"),
        help: "ask for fewer with --threads N".into(),
    })?;
    Ok(pool.install(work))
}
