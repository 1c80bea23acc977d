//! `acm-eval import`: a network that was trained elsewhere, scored as a run's own.

mod sidecar;
mod tensors;

use std::path::{Path, PathBuf};

use acm_eval::{error::EvalError, terminal::print};
use acm_train::{
    config::{self, Experiment, Imported, Source},
    run::{import::Foreign, progress::Progress, record::read_records, stop::Stop},
    schedule::{import, job, request::Request},
    store::hashed,
};
use clap::Args;

use acm_eval::stream::saved::chosen;
use sidecar::Sidecar;

/// Above the options, in full.
pub const ABOUT: &str = "\
Scores a network that was trained elsewhere: in PyTorch, by the names of torch and ncps

Nothing is trained. The network takes the place of a run's: the same data, windows and parts, the same nominal model, the \
same scores. What comes out is a run folder like any other, for report, stream and export.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval import out/estimator.safetensors --like runs/gru --out runs/back
      What `acm-eval export runs/gru --torch out` wrote, after PyTorch has learned on or as it was
  acm-eval import gru.safetensors --like experiments/gru.toml --set network.units=16
      A torch.nn.GRU with a torch.nn.Linear of your own, which was trained on standardised channels of this experiment
  acm-eval import gru.safetensors --like runs/gru --about scalers.json
      The same with scalers of your own

A file holds the parameters of a torch.nn.GRU, an ncps.torch.CfC or a torch.nn.Sequential of linear layers, and
of one torch.nn.Linear over its features, by any names in front: rnn.weight_ih_l0, core.rnn_cell.ff1.weight,
0.weight. `safetensors.torch.save_file(module.state_dict(), FILE)` writes it. What torch.save wrote (.pt, .pth) is
read where acm-eval was built with --features pytorch.

Beside it lies a JSON file with what weights do not say, as the export writes it: gru.safetensors is read with
gru_torch.json, or with --about FILE. All of it may be left out:
  {\"network\":  {\"kind\": \"gru\", \"units\": 16, \"layers\": 1},
   \"channels\": [{\"signal\": \"q1\", \"rate\": false}, {\"signal\": \"q1\", \"rate\": true}],
   \"inputs\":   {\"mean\": [0.1, 0.0], \"spread\": [0.4, 1.2]},
   \"targets\":  {\"mean\": [0.0, 0.0, 0.0], \"spread\": [0.02, 0.02, 0.01]}}
Without network and channels those of the experiment are meant. Without inputs and targets (mean and spread of the
channels and of the residual, SI) the network has learned with those of the experiment's training part. Others are
taken up by the first and the last layer, so that the run has the scalers that its data give.

Exit codes: 0 scored; 2 usage or experiment file; 3 data, or a file that is not this network; 4 file system; 5 the run
folder is in use.";

/// What may be asked for.
#[derive(Args)]
pub struct ImportArgs {
    /// Parameters: a file of safetensors
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Run folder or experiment file: data, channels, windows and parts to score on
    #[arg(long, value_name = "RUN")]
    like: PathBuf,
    /// Run folder to make [default: runs/ and the file's name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What weights do not say, as JSON [default: FILE with _torch.json at its end, where it is there]
    #[arg(long, value_name = "FILE")]
    about: Option<PathBuf>,
    /// In the place of which network of the run, such as final-seed1 [default: that which export takes]
    #[arg(long, value_name = "ID")]
    network: Option<String>,
    /// Replace one value of the experiment, as a dotted key and a TOML value or a plain text; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Folder with the tables of the run's data set, where they do not lie beside its manifest
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

/// Scores the network, and prints the table of its run.
pub fn run(args: &ImportArgs) -> Result<(), EvalError> {
    let sidecar = Sidecar::of(&args.file, args.about.as_deref())?;
    let (experiment, source) = experiment(args, &sidecar)?;
    let file = name(&args.file);
    let imported = Imported { file: file.clone(), sha256: hashed::of_file(&args.file)? };
    let foreign = Foreign { file, tensors: tensors::read(&args.file)?, scalers: sidecar.scalers() };
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from("runs").join(args.file.file_stem().unwrap_or_default()));
    let (progress, stop) = (Progress::new(false), Stop::default());
    let request = Request { data: args.data.as_deref(), ..Request::new(&out, &progress, &stop) };
    let record = import::run(experiment, &source, &request, &foreign, imported)?;
    print(&job::report(&[record], &out)?)
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Returns the experiment that the network is scored as, with the part of the run whose place it takes.
fn experiment(args: &ImportArgs, sidecar: &Sidecar) -> Result<(Experiment, Source), EvalError> {
    let is_run = args.like.is_dir();
    let file = if is_run { args.like.join("experiment.toml") } else { args.like.clone() };
    if is_run && !file.is_file() {
        return Err(EvalError::NotARun { path: args.like.clone(), missing: "experiment.toml" });
    }
    let (mut experiment, source) = config::read(&file, &args.set)?;
    if is_run {
        let record = chosen(read_records(&args.like)?, &args.like, args.network.as_deref())?;
        experiment.protocol.seeds = vec![record.seed];
        experiment.protocol.validation_fold = record.folds.map(|folds| folds.fold);
    } else if let Some(id) = &args.network {
        return Err(EvalError::Usage(format!("--network {id} is one of a run folder; give that with --like")));
    }
    sidecar.apply(&mut experiment)?;
    Ok((experiment, source))
}
