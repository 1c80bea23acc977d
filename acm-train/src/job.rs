//! A job: a file in, a folder out.
//!
//! A file asks for one experiment, or for a study, which is a list of them or a question to the nominal model alone.

use std::{num::NonZeroUsize, path::Path, slice};

use crate::{
    cli::{Cli, EngineName},
    engine::{self, Answer, Engine},
    error::TrainError,
    experiment::{self, Experiment, Source},
    folder::Hold,
    progress::Progress,
    queue,
    ready::{Campaigns, Ready},
    record::RunRecord,
    slurm::{self, Slurm},
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
    /// Who computes the runs.
    pub engine: &'a Engine,
    /// Who is told.
    pub progress: &'a Progress,
    /// Who may end it early.
    pub stop: &'a Stop,
}

impl<'a> Request<'a> {
    /// A job in a folder of its own, computed here, with as many runs at a time as there are cores.
    pub fn new(out: &'a Path, progress: &'a Progress, stop: &'a Stop) -> Self {
        let (data, jobs, threads, engine) = (None, None, None, &Engine::Local);
        Self { data, out, resume: false, jobs, threads, engine, progress, stop }
    }

    /// Who else may be in the folder.
    pub fn hold(&self) -> Hold {
        match self.engine {
            Engine::Local => Hold::Alone { resume: self.resume },
            Engine::Slurm(_) if self.engine.only_looks() => Hold::Look,
            Engine::Slurm(_) => Hold::Shared,
        }
    }
}

/// Does what the command line asks, and returns the table to print.
///
/// # Errors
/// Anything in [`TrainError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(cli: &Cli) -> Result<String, TrainError> {
    refuse_strange_options(cli)?;
    let (progress, stop, out) = (Progress::new(cli.quiet), Stop::on_signals()?, cli.out());
    let (data, resume, jobs, threads) = (cli.data.as_deref(), cli.resume, cli.jobs, cli.threads);
    let Some(config) = &cli.config else {
        let file = cli.task.as_deref().unwrap_or(Path::new(""));
        return slurm::task::conduct(file, threads, &progress, &stop);
    };
    let mut source = Source::read(config, &cli.set)?;
    let engine = engine(cli, &source)?;
    let request = Request { data, out: &out, resume, jobs, threads, engine: &engine, progress: &progress, stop: &stop };
    match study::kind(&source)? {
        Some(kind) => study::conduct(kind, source, &request),
        None => {
            let experiment = experiment::of_source(&mut source)?;
            one(experiment, &source, &request)
        }
    }
}

/// Options of the engine that was not asked for.
fn refuse_strange_options(cli: &Cli) -> Result<(), TrainError> {
    let refuse = |what: String, help: &str| Err(TrainError::Usage { what, help: help.into() });
    match (cli.engine, cli.slurm.given()) {
        (EngineName::Local, Some(option)) => {
            refuse(format!("{option} is for Slurm"), "add --engine slurm, or leave it out")
        }
        (EngineName::Slurm, _) if cli.jobs.is_some() => refuse(
            "--jobs is for runs on this machine".into(),
            "for runs at the same time on a cluster write --array-limit N",
        ),
        _ => Ok(()),
    }
}

fn engine(cli: &Cli, source: &Source) -> Result<Engine, TrainError> {
    if cli.engine == EngineName::Local {
        return Ok(Engine::Local);
    }
    let fingerprint = slurm::fingerprint(source)?;
    slurm::refuse_changes(cli.slurm.unchanged.as_deref(), &fingerprint, source)?;
    let arguments = std::env::args().skip(1).collect();
    Ok(Engine::Slurm(Slurm { options: cli.slurm.clone(), arguments, fingerprint }))
}

fn one(experiment: Experiment, source: &Source, request: &Request) -> Result<String, TrainError> {
    let ready = Ready::new(experiment, source, request, &mut Campaigns::default())?;
    let folder = ready.claim(request.out, request.hold())?;
    tell(&ready, request);
    Ok(match engine::run(slice::from_ref(&ready), slice::from_ref(&folder), request)? {
        Answer::Waiting(text) => text,
        Answer::Finished(_) if request.engine.only_looks() => engine::nothing_to_submit(ready.plans.len()),
        Answer::Finished(records) => report(&records.concat(), request.out),
    })
}

fn tell(ready: &Ready, request: &Request) {
    request.progress.note(&ready.description());
    request.progress.note(&summary::count(ready.plans.len(), "run"));
}

/// Runs an experiment here to its final scores; `source` says where its values came from, and paths are found from there.
///
/// The same experiment with another `nominal` is scored at the same time stamps ([`crate::held_out`]).
///
/// # Errors
/// As [`conduct`].
pub fn run(experiment: Experiment, source: &Source, request: &Request) -> Result<Vec<RunRecord>, TrainError> {
    let ready = Ready::new(experiment, source, request, &mut Campaigns::default())?;
    let folder = ready.claim(request.out, Hold::Alone { resume: request.resume })?;
    tell(&ready, request);
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
