//! A job: an experiment file in, a run folder out.
//!
//! Runs are independent, so they may go on side by side; each is computed by its own rule from its own seed, and its
//! record is written as soon as it is done. The order of records, of the log and of the table is that of the plan.

use std::{
    num::NonZeroUsize,
    path::Path,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use acm_core::Calibration;
use acm_datasets::Campaign;

use crate::{
    atomic, augmented,
    cli::Cli,
    error::TrainError,
    experiment::{self, Experiment, Source},
    floors,
    folder::RunFolder,
    nominal::{calibrations, choose},
    plan::{Plan, plans},
    prepare::{channels, filtered, refuse_long_windows, stamp},
    progress::Progress,
    record::{NominalRecord, NominalSource, RunRecord},
    run::{Outcome, Setting, train},
    stop::Stop,
    study, summary, training_log,
};

/// Where and how an experiment is run.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Folder of the data set's tables, where they do not lie beside its manifest.
    pub data: Option<&'a Path>,
    /// Run folder.
    pub out: &'a Path,
    /// Whether to go on with what the run folder holds.
    pub resume: bool,
    /// Runs at the same time; the number of cores where it is left out.
    pub jobs: Option<NonZeroUsize>,
    /// Threads within each run; the cores shared among the runs where it is left out.
    pub threads: Option<NonZeroUsize>,
    /// Who is told.
    pub progress: &'a Progress,
    /// Who may end it early.
    pub stop: &'a Stop,
}

/// Does what the command line asks, and returns the table to print.
///
/// # Errors
/// Anything in [`TrainError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(cli: &Cli) -> Result<String, TrainError> {
    let mut source = Source::read(&cli.config, &cli.set)?;
    let (progress, stop, out) = (Progress::new(cli.quiet), Stop::on_signals()?, cli.out());
    let (data, resume, jobs, threads) = (cli.data.as_deref(), cli.resume, cli.jobs, cli.threads);
    let request = Request { data, out: &out, resume, jobs, threads, progress: &progress, stop: &stop };
    match study::kind(&source)? {
        Some(kind) => study::conduct(kind, source, &request),
        None => {
            let experiment = experiment::of_source(&mut source)?;
            Ok(report(&run(experiment, &source, &request)?, &out))
        }
    }
}

/// Runs an experiment to its final scores; `source` says where its values came from, and paths are found from there.
///
/// The same experiment with another `nominal` is scored at the same time stamps ([`crate::held_out`]).
///
/// # Errors
/// As [`conduct`].
pub fn run(mut experiment: Experiment, source: &Source, request: &Request) -> Result<Vec<RunRecord>, TrainError> {
    let campaign = read_campaign(&mut experiment, source, request)?;
    let channels = channels(&mut experiment, source, &campaign)?;
    let plans = plans(&experiment, source, &campaign)?;
    refuse_long_windows(&experiment, source, &campaign, &plans)?;
    let choice = choose(&experiment.nominal, source, &campaign)?;
    let folder = RunFolder::claim(request.out, request.resume)?;
    let data = stamp(&campaign, floors::read(&campaign.folder)?);
    let nominal = calibrations(&choice, &campaign, &plans, data)?;
    folder.adopt(&experiment, &nominal)?;
    describe(&nominal, &plans, request.progress);
    let setting = Setting { experiment: &experiment, campaign: &campaign, channels: &channels, nominal: &nominal };
    Job { setting, plans: &plans, folder: &folder, progress: request.progress, stop: request.stop }.run(request)
}

fn read_campaign(experiment: &mut Experiment, source: &Source, request: &Request) -> Result<Campaign, TrainError> {
    let folder = experiment::find_folder(&experiment.data, source.path()).ok_or_else(|| {
        let what = format!("`data` is {:?}, and there is no such folder", experiment.data);
        let help = "name a folder with a manifest.toml, as seen from the current directory or from the experiment file";
        Box::new(source.complaint(&["data".to_string()], what, help))
    })?;
    let campaign = Campaign::read(&folder, request.data)?;
    for warning in &campaign.warnings {
        request.progress.note(&format!("warning: {warning}"));
    }
    filtered(augmented::predicted(campaign, &mut experiment.nominal, source)?, experiment)
}

fn describe(nominal: &NominalRecord, plans: &[Plan], progress: &Progress) {
    let synthetic = if nominal.data.synthetic { " (synthetic data)" } else { "" };
    progress.note(&format!("{}{synthetic}", nominal.data.title));
    let (scale, unit) = summary::shown_unit(&nominal.data.unit);
    for pair in nominal.calibrations.values() {
        let rms = |fitted: &Calibration| format!("{:.2} {unit}", scale * fitted.rms_total);
        let brought = if nominal.source == NominalSource::Augmented { "as it was saved" } else { "the data's own" };
        let own = pair.nominal.as_ref().map_or(brought.to_string(), rms);
        let trials = pair.trials.join(" ");
        progress.note(&format!("calibrated on {trials}: nominal {own}, polynomial {}", rms(&pair.polynomial)));
    }
    progress.note(&summary::count(plans.len(), "run"));
}

fn report(records: &[RunRecord], out: &Path) -> String {
    let root = out.display();
    let references: Vec<&RunRecord> = records.iter().collect();
    format!(
        "{}\n\nrecords, predictions, training.log: {root}\nfigures and a page: cargo run -p acm-eval -- report {root}",
        summary::text(&references)
    )
}

/// The runs of one experiment, and where they are written.
struct Job<'a> {
    setting: Setting<'a>,
    plans: &'a [Plan],
    folder: &'a RunFolder,
    progress: &'a Progress,
    stop: &'a Stop,
}

impl Job<'_> {
    /// Runs what is not finished, and returns all records in the order of the plan.
    fn run(&self, request: &Request) -> Result<Vec<RunRecord>, TrainError> {
        let done = self.plans.iter().map(|plan| self.folder.finished(&plan.id)).collect::<Result<Vec<_>, _>>()?;
        let open = done.iter().filter(|record| record.is_none()).count();
        let cores = thread::available_parallelism().map_or(1, |n| n.get());
        let jobs = request.jobs.map_or(cores, |n| n.get()).min(open.max(1));
        let threads = request.threads.map_or((cores / jobs).max(1), |n| n.get());
        let board = Board { records: Mutex::new(done), next: AtomicUsize::new(0), failure: Mutex::new(None) };
        thread::scope(|scope| {
            for _ in 0..jobs {
                scope.spawn(|| self.work(&board, threads));
            }
        });
        let records = self.outcome(board)?;
        self.log(&records)?;
        Ok(records)
    }

    /// Takes one plan after the other until there is none, somebody asks to stop, or a run fails.
    fn work(&self, board: &Board, threads: usize) {
        while !self.stop.asked() {
            let index = board.next.fetch_add(1, Ordering::SeqCst);
            let Some(plan) = self.plans.get(index) else { return };
            if lock(&board.records)[index].is_some() {
                continue;
            }
            if let Err(error) = self.one(plan, index, board, threads) {
                self.stop.ask();
                lock(&board.failure).get_or_insert(error);
            }
        }
    }

    fn one(&self, plan: &Plan, index: usize, board: &Board, threads: usize) -> Result<(), TrainError> {
        let trained = within(threads, || train(&self.setting, plan, self.folder, self.progress, self.stop))??;
        if let Outcome::Finished(record) = trained {
            let mut records = lock(&board.records);
            atomic::write_json(&self.folder.record(&plan.id), &record)?;
            records[index] = Some(*record);
            self.log(records.iter().flatten())?;
        }
        Ok(())
    }

    fn log<'r>(&self, records: impl IntoIterator<Item = &'r RunRecord>) -> Result<(), TrainError> {
        let finished: Vec<&RunRecord> = records.into_iter().collect();
        let text = training_log::text(self.setting.nominal, &finished);
        atomic::write(&self.folder.path("training.log"), text.as_bytes())
    }

    fn outcome(&self, board: Board) -> Result<Vec<RunRecord>, TrainError> {
        if let Some(error) = lock(&board.failure).take() {
            return Err(error);
        }
        let records: Vec<RunRecord> = lock(&board.records).drain(..).flatten().collect();
        if records.len() == self.plans.len() {
            return Ok(records);
        }
        let (folder, finished) = (self.folder.root().into(), records.len());
        Err(TrainError::Stopped { folder, finished, planned: self.plans.len() })
    }
}

/// What the workers share.
struct Board {
    records: Mutex<Vec<Option<RunRecord>>>,
    next: AtomicUsize,
    failure: Mutex<Option<TrainError>>,
}

/// A worker that panicked leaves its data as they were: whole.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Runs `work` with a pool of its own, so that runs side by side do not share threads.
fn within<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, TrainError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| TrainError::Usage {
        what: format!("cannot start {threads} threads: {error}"),
        help: "ask for fewer with --threads N".into(),
    })?;
    Ok(pool.install(work))
}
