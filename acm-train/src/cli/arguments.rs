//! The command line.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::{Parser, ValueEnum};

use acm_datasets::text::help::help;

use crate::schedule::engine::kubernetes;
use crate::schedule::engine::slurm::Options;

const ABOUT: &str = "Trains networks on the residual of a robot's nominal model.

Reads an experiment file, calibrates the nominal model on the calibration trials, trains a network on its residual on \
the development trials, and prints the error before and after on held-out trials.";

const EXAMPLES: &str = r#"Examples:
  acm-train --config experiments/cfc.toml
      The main job: results in runs/cfc, a table at the end.
  acm-train --config experiments/cfc.toml --set training.epochs=3 --out runs/quick
      The same experiment with other values; each --set is a line of the experiment file:
      --set network.kind=gru --set 'protocol.seeds=[1, 2]' --set data=~/recordings/arm
  acm-train --config experiments/cfc.toml --resume
      Continues after Ctrl-C, a power cut or a full disk. The result is the same, bit for bit.
  acm-train --config experiments/my-robot.toml --set data=my-robot
      Your own data: a folder with manifest.toml. --data DIR names the folder of its tables, if elsewhere.
  acm-train --config experiments/sweep.toml --engine slurm --partition gpu --array-limit 20
      The same on a cluster: submits missing runs as job arrays, one run a task, and returns at once. A collector
      submits failed runs again and writes the tables; so does the same command, and --wait returns when all is done.
      --dry-run shows the scripts. Any engine can continue a folder.
  acm-train --config experiments/sweep.toml --engine kubernetes --image IMAGE --claim VOLUME --cpus 2 --memory 4Gi
      Writes the manifest of an Indexed Job, one run a pod; submit it with kubectl apply.
  acm-train --config experiments/ablation.toml
      A study: many experiments from a list of edits, side by side. Its file has a key `study`: sweep, ablation,
      comparison, inputs, best; nominal and residual describe the nominal model and its residual.

  acm-train --config experiments/my-best.toml --set set.data=my-robot
      Chooses a model: all are compared under the folds, and only the winner is scored on held-out trials.

An experiment file names only what differs from the defaults:
  question = "What does memory gain?"
  data     = "datasets/acm-twin"
  [windows]                        # length, reach, stride, max_gap, target, ...
  length = 25
  [network]                        # kind, and that network's own fields
  kind = "gru"
  [baseline]                       # ridge or boosted_trees instead
  kind = "ridge"
  [training]                       # epochs, batch, learning_rate, ...
  epochs = 20
  [protocol]                       # cross_validation, final, seeds, folds, leave_out, ...
  seeds = [1, 2, 3]
  leave_out = "payload"            # or "trial", "block"; by default a rule that the table names
  [inputs]                         # channels, select, domain_filter, ...
  channels = ["q1", "q2", "rate(q1)"]
  select = true                    # use the fewest of them within one standard error of the best, by cross-validation
  [nominal]                        # model, strain, degree, ...
  model = "strain"                 # or augmented = "…/model.json" of a closed loop
The experiment.toml in a run folder lists every field with the value that was used.

Exit codes: 0 done, 2 usage or experiment file, 3 data, or a loss that is not finite, 4 file system, 5 run folder in use, 130 stopped by Ctrl-C."#;

/// Arguments of `acm-train`.
#[derive(Debug, Parser)]
#[command(name = "acm-train", version, about = ABOUT, after_long_help = help(EXAMPLES), max_term_width = 100)]
pub struct Cli {
    /// Experiment file: one question, its data, its network; or a study.
    #[arg(long, value_name = "FILE", required_unless_present = "task")]
    pub config: Option<PathBuf>,

    /// Run folder [default: runs/ and the experiment file's name]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Folder with the data set's tables, where they are not beside its manifest.
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,

    /// Continue the unfinished runs of the run folder.
    #[arg(long)]
    pub resume: bool,

    /// Replace one value of the experiment file, as a dotted key and a TOML value or a plain text; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Runs (folds, seeds) at the same time [default: number of cores]. Results do not depend on it.
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroUsize>,

    /// Threads within each run [default: cores shared among the runs]. Results do not depend on it.
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,

    /// Engine that computes the runs.
    #[arg(long, value_enum, value_name = "ENGINE", default_value_t)]
    pub engine: EngineName,

    /// Run one task of an array: the list that the engine wrote. Its index comes from SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["config", "out", "data", "set"])]
    pub task: Option<PathBuf>,

    /// No progress: only the table, and errors.
    #[arg(long)]
    pub quiet: bool,

    /// For Slurm.
    #[command(flatten)]
    pub slurm: Options,

    /// For Kubernetes.
    #[command(flatten)]
    pub kubernetes: kubernetes::Options,
}

/// Engines that compute runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum EngineName {
    /// This process.
    #[default]
    Local,
    /// Job arrays of Slurm, one run a task; the same command again goes on, and prints the tables in the end.
    Slurm,
    /// An Indexed Job of Kubernetes, one run a pod: writes the manifest that kubectl takes.
    Kubernetes,
}

impl Cli {
    /// Returns the run folder: `--out`, or `runs/<name of the experiment file>`.
    pub fn out(&self) -> PathBuf {
        let name = self.config.as_ref().and_then(|file| file.file_stem()).unwrap_or("experiment".as_ref());
        self.out.clone().unwrap_or_else(|| PathBuf::from("runs").join(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn the_run_folder_is_named_after_the_experiment() {
        let cli = Cli::parse_from(["acm-train", "--config", "experiments/cfc.toml"]);
        assert_eq!(cli.out(), PathBuf::from("runs/cfc"));
    }
}
