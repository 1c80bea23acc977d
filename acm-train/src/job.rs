//! A job: a file in, a folder out.
//!
//! A file asks for one experiment, or for a study, which is a list of them or a question to the nominal model alone.

use std::{num::NonZeroUsize, path::Path, slice};

use crate::{
    cli::Cli,
    error::TrainError,
    experiment::{self, Experiment, Source},
    progress::Progress,
    queue,
    ready::{Campaigns, Ready},
    record::RunRecord,
    stop::Stop,
    study, summary,
};

/// Where and how a job is done.
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
pub fn run(experiment: Experiment, source: &Source, request: &Request) -> Result<Vec<RunRecord>, TrainError> {
    let ready = Ready::new(experiment, source, request, &mut Campaigns::default())?;
    let folder = ready.claim(request.out, request.resume)?;
    request.progress.note(&ready.description());
    request.progress.note(&summary::count(ready.plans.len(), "run"));
    Ok(queue::run(slice::from_ref(&ready), slice::from_ref(&folder), request)?.into_iter().flatten().collect())
}

fn report(records: &[RunRecord], out: &Path) -> String {
    let root = out.display();
    let references: Vec<&RunRecord> = records.iter().collect();
    format!(
        "{}\n\nrecords, predictions, training.log: {root}\nfigures and a page: cargo run -p acm-eval -- report {root}",
        summary::text(&references)
    )
}
