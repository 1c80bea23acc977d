//! Request of a job: its folder, its limits and its engine.

use std::{num::NonZeroUsize, path::Path};

use super::engine::kubernetes::options::Options as Pods;
use super::engine::slurm::asked::Slurm;
use super::engine::slurm::options::Options as Limits;
use crate::{
    run::{progress::Progress, stop::Stop},
    store::Hold,
};

/// Engine that computes the runs.
#[derive(Debug, Clone)]
pub enum Engine {
    /// This process, some runs at a time.
    Local,
    /// Tasks of Slurm's job arrays, one run each.
    Slurm(Slurm),
    /// Pods of a Job of Kubernetes, one run each, with the limits that Slurm has.
    Kubernetes(Pods, Limits),
}

impl Engine {
    /// Returns whether nothing is to be written: a dry run.
    pub fn only_looks(&self) -> bool {
        matches!(self, Self::Slurm(slurm) if slurm.options.dry_run)
    }
}

/// Settings of how and where a job runs.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Folder of the data set's tables, where they do not lie beside its manifest.
    pub data: Option<&'a Path>,
    /// Run folder.
    pub out: &'a Path,
    /// Whether to continue the runs of the folder.
    pub resume: bool,
    /// Number of runs at the same time; the number of cores where it is left out.
    pub jobs: Option<NonZeroUsize>,
    /// Number of threads within each run; the cores shared among the runs where it is left out.
    pub threads: Option<NonZeroUsize>,
    /// Engine that computes the runs.
    pub engine: &'a Engine,
    /// Observer of progress.
    pub progress: &'a Progress,
    /// Signal that may end the job early.
    pub stop: &'a Stop,
}

impl<'a> Request<'a> {
    /// Returns a job in a folder of its own, computed here, with as many runs at a time as there are cores.
    pub fn new(out: &'a Path, progress: &'a Progress, stop: &'a Stop) -> Self {
        let (data, jobs, threads, engine) = (None, None, None, &Engine::Local);
        Self { data, out, resume: false, jobs, threads, engine, progress, stop }
    }

    /// Returns the mode of sharing the folder.
    pub fn hold(&self) -> Hold {
        match self.engine {
            Engine::Local => Hold::Alone { resume: self.resume },
            Engine::Slurm(_) if self.engine.only_looks() => Hold::Look,
            Engine::Slurm(_) | Engine::Kubernetes(..) => Hold::Shared,
        }
    }
}
