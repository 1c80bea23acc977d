//! Options of the command line for Slurm.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::Args;

/// Options of `--engine slurm`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
#[command(next_help_heading = "With --engine slurm")]
pub struct Options {
    /// Partition of the cluster.
    #[arg(long, value_name = "NAME")]
    pub partition: Option<String>,

    /// Account that is charged.
    #[arg(long, value_name = "NAME")]
    pub account: Option<String>,

    /// Time limit of each run, as sbatch takes it. A run that is cut off continues from its checkpoint in the next array.
    #[arg(long, value_name = "TIME")]
    pub time: Option<String>,

    /// Memory of each run, as sbatch takes it.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,

    /// Processors, and threads, of each run [default: 1]
    #[arg(long, value_name = "N")]
    pub cpus: Option<NonZeroUsize>,

    /// Largest number of runs at the same time.
    #[arg(long, value_name = "N")]
    pub array_limit: Option<NonZeroUsize>,

    /// Attempts of a run from the same epoch before it is given up [default: 3]
    #[arg(long, value_name = "N")]
    pub attempts: Option<NonZeroUsize>,

    /// Any other option, passed on to sbatch: --sbatch=--constraint=avx512; may be repeated.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    pub sbatch: Vec<String>,

    /// Program that tasks call instead of this one, with its arguments: a wrapper that loads modules, or starts a container.
    #[arg(long, value_name = "FILE")]
    pub program: Option<PathBuf>,

    /// Print the scripts and what would be submitted; write and submit nothing.
    #[arg(long)]
    pub dry_run: bool,

    /// Wait until all runs are done, submit failed runs again, and print the tables.
    #[arg(long, conflicts_with = "dry_run")]
    pub wait: bool,

    /// Hash of the configuration that a collector was submitted for; it stops where the files have changed.
    #[arg(long, value_name = "SHA256", hide = true)]
    pub unchanged: Option<String>,
}

impl Options {
    /// Returns the largest number of attempts at a run from the same epoch.
    pub fn cap(&self) -> usize {
        self.attempts.map_or(3, NonZeroUsize::get)
    }

    /// Returns the first option that only sbatch knows.
    pub fn submits(&self) -> Option<&'static str> {
        let shared = ["--memory", "--cpus", "--array-limit", "--attempts", "--program", "--dry-run"];
        self.all_given().find(|name| !shared.contains(name))
    }

    /// Returns the first option that was given, as it is written.
    pub fn given(&self) -> Option<&'static str> {
        self.all_given().next()
    }

    fn all_given(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("--partition", self.partition.is_some()),
            ("--account", self.account.is_some()),
            ("--time", self.time.is_some()),
            ("--memory", self.memory.is_some()),
            ("--cpus", self.cpus.is_some()),
            ("--array-limit", self.array_limit.is_some()),
            ("--attempts", self.attempts.is_some()),
            ("--sbatch", !self.sbatch.is_empty()),
            ("--program", self.program.is_some()),
            ("--dry-run", self.dry_run),
            ("--wait", self.wait),
            ("--unchanged", self.unchanged.is_some()),
        ];
        given.into_iter().filter_map(|(name, given)| given.then_some(name))
    }
}
