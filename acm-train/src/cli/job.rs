//! Job of the command line: a file in, a folder out.
//!
//! A file asks for one experiment, or for a study, which is a list of them or a question to the nominal model alone.

use std::path::Path;

use super::{
    arguments::{Cli, EngineName},
    error::TrainError,
};
use crate::config::{Source, kind, of_source};
use crate::run::progress::Progress;
use crate::run::stop::Stop;
use crate::schedule::engine::slurm::{self, Slurm};
use crate::schedule::request::{Engine, Request};
use crate::schedule::{job, study};

/// Runs the job that the command line requests, and returns the table to print.
///
/// # Errors
/// Anything in [`TrainError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(cli: &Cli) -> Result<String, TrainError> {
    conduct_with(cli, &Progress::new(cli.quiet), &Stop::on_signals()?)
}

/// Runs the job as [`conduct`] does, for a program with its own progress and signals.
///
/// # Errors
/// As [`conduct`].
pub fn conduct_with(cli: &Cli, progress: &Progress, stop: &Stop) -> Result<String, TrainError> {
    refuse_strange_options(cli)?;
    let out = cli.out();
    let (data, resume, jobs, threads) = (cli.data.as_deref(), cli.resume, cli.jobs, cli.threads);
    let Some(config) = &cli.config else {
        let file = cli.task.as_deref().unwrap_or(Path::new(""));
        return Ok(slurm::array::task::conduct(file, threads, progress, stop)?);
    };
    let mut source = Source::read(config, &cli.set)?;
    let engine = engine(cli, &source)?;
    let request = Request { data, out: &out, resume, jobs, threads, engine: &engine, progress, stop };
    match kind(&source)? {
        Some(kind) => Ok(study::conduct(kind, source, &request)?),
        None => {
            let experiment = of_source(&mut source)?;
            Ok(job::conduct(experiment, &source, &request)?)
        }
    }
}

/// Refuses options of an engine that was not requested.
fn refuse_strange_options(cli: &Cli) -> Result<(), TrainError> {
    let refuse = |what: String, help: &str| Err(TrainError::Usage { what, help: help.into() });
    match (cli.engine, cli.slurm.given()) {
        (EngineName::Local | EngineName::Slurm, _) if cli.kubernetes.given().is_some() => {
            let option = cli.kubernetes.given().unwrap_or_default();
            refuse(format!("{option} is for Kubernetes"), "add --engine kubernetes, or leave it out")
        }
        (EngineName::Kubernetes, _) if cli.jobs.is_some() || cli.slurm.submits().is_some() => {
            let option = cli.slurm.submits().unwrap_or("--jobs");
            refuse(
                format!("{option} is not for Kubernetes"),
                "of the limits, --cpus, --memory, --array-limit, --attempts and --program hold",
            )
        }
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
    match cli.engine {
        EngineName::Local => return Ok(Engine::Local),
        EngineName::Kubernetes => return Ok(Engine::Kubernetes(cli.kubernetes.clone(), cli.slurm.clone())),
        EngineName::Slurm => {}
    }
    let fingerprint = slurm::fingerprint(source)?;
    slurm::refuse_changes(cli.slurm.unchanged.as_deref(), &fingerprint, source)?;
    let arguments = std::env::args().skip(1).collect();
    Ok(Engine::Slurm(Slurm { options: cli.slurm.clone(), arguments, fingerprint }))
}
