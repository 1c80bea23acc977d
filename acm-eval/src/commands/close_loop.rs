//! `acm-eval close-loop`: from recordings and a nominal model to the physical effect that the model lacks.

use std::path::{Path, PathBuf};

use acm_datasets::Campaign;
use acm_eval::{
    closed_loop,
    error::EvalError,
    loop_config::LoopConfig,
    loop_folder::LoopFolder,
    network_table::Trainings,
    recordings::{Recordings, recordings},
};
use acm_trace::{
    close::{About, Closed, close},
    finding::{Data, Errors},
};
use acm_train::{
    experiment::{NominalKind, Source},
    nominal::choose,
};
use clap::Args;

use super::steps::Steps;

/// Above the options, in full.
pub const ABOUT: &str = "\
Finds the physical effect that a nominal model lacks, and reports the error before and after

Takes recordings and a nominal model, looks at what the model misses, traces it to an effect (a dead time, backlash, a tip \
load, …), puts that effect at its place, fits everything again, and compares on trials that took no part. Or it says \
honestly that nothing is missing, that it knows no such effect, or that these data cannot tell two effects apart.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval close-loop my-robot
      Your recordings: a folder with manifest.toml. Result: runs/loop-my-robot/loop.html
  acm-eval close-loop my-robot --data ~/recordings --out first
      The same, with the tables elsewhere, into a folder of your choice.
  acm-eval close-loop my-robot --set search.most=2 --set 'effects.without=[\"creep\"]'
      Two effects at most, and no creep; each --set is a line of a configuration.
  acm-eval close-loop --config experiments/close-the-loop.toml
      A question in a file, with networks on top.

Your own recordings: write a manifest.toml beside your CSV files. A small one:
  [table]
  files = [\"*.csv\"]                # one file a trial, named after it
  trial = { file = \"(.*)\" }
  time  = { column = \"t\", unit = \"s\" }
  [[actuator]]                     # what is commanded or read back; as many as there are
  column = \"q1\"
  unit   = \"rad\"
  [[measured]]                     # what comes out: positions, angles or forces
  column = \"x\"
  unit   = \"mm\"
  [roles]
  calibration = [\"slow\"]
  development = [\"run1\", \"run2\", \"run3\"]
  held_out    = [\"run4\"]
What else is known at each sample (pressure, throttle, altitude) is a [[context]]; your own model's
prediction is a [[predicted]]; [arm] describes a continuum arm. Without the last two the nominal
model is a polynomial. `acm-data check my-robot` tells what is wrong with a manifest or a table.

What the roles do:
  calibration   Fits the nominal model: slow, or at rest. May be left out; that is weaker.
  development   Here the effect is found. Move every actuator, at several speeds, with reversals
                and pauses; three trials or more.
  held_out      Takes no part until the final numbers. Without any, the last 30 % of each
                development trial stay untouched.

A configuration names only what differs from the defaults:
  question = \"What does the nominal model lack?\"
  data     = \"my-robot\"
  [nominal]                        # model (strain, polynomial, predicted), degree, length, ...
  degree = 2
  [effects]                        # which are tried: only = [...], without = [...]
  without = [\"creep\"]
  [search]                         # most, samples, seed
  most = 3
  [networks]                       # nominal, + effect, + network, + both, in one table
  experiment = \"experiments/cfc.toml\"
Of that experiment, data and [nominal] are the loop's own.

Results in DIR: loop.html for people, loop.json for programs, and model.json, the model with what
it lacked: acm-train takes it as [nominal] augmented = \"DIR/model.json\". An earlier result is
replaced once the new one is complete; a folder that holds anything else is left alone.

Exit codes: 0 done, whatever was found; 2 usage or configuration; 3 data, with file, row and
column; 4 file system; 5 DIR is in use; 130 stopped by Ctrl-C while networks were trained: the same
command continues.";

/// What may be asked for.
#[derive(Args)]
pub struct CloseArgs {
    /// Data set: a folder with manifest.toml
    #[arg(required_unless_present = "config", conflicts_with = "config")]
    folder: Option<PathBuf>,
    /// Configuration, which names the data set
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Folder with the tables, where they do not lie beside the manifest
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder of the result [default: runs/loop- and the name of the folder or of the configuration]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace one value of the configuration, as a dotted key and a TOML value; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Writes the result; prints the summary and where the page is.
pub fn run(args: &CloseArgs) -> Result<(), EvalError> {
    let (config, source, folder) = asked(args)?;
    let data = args.data.as_deref();
    let campaign = Campaign::read(&folder, data).map_err(EvalError::Table)?;
    campaign.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    let given = case(&config, &source, &campaign)?;
    let trainings = Trainings::of(&config, &source, &campaign, data)?;
    let out = LoopFolder::claim(&out(args, &folder))?;
    let mut closed = closed(given, &config, &campaign)?;
    let mut page = out.write(&closed)?;
    if let Some(trainings) = trainings {
        let scale = if matches!(closed.finding.errors, Errors::Length { .. }) { 1e3 } else { 1.0 };
        closed.finding.networks = trainings.rows(&out.model(), &out.networks(), scale)?;
        page = out.write(&closed)?;
    }
    println!("{}\n\n{}", closed_loop::summary(&closed.finding), page.display());
    Ok(())
}

/// The question, where its values were written, and the folder of the data set.
fn asked(args: &CloseArgs) -> Result<(LoopConfig, Source, PathBuf), EvalError> {
    let (config, source) = match (&args.config, &args.folder) {
        (Some(file), _) => LoopConfig::read(file, &args.set)?,
        (None, folder) => LoopConfig::for_folder(folder.as_deref().unwrap_or(Path::new(".")), &args.set)?,
    };
    let folder = match &args.folder {
        Some(folder) => folder.clone(),
        None => config.data_folder(&source)?,
    };
    if config.nominal.model == Some(NominalKind::None) {
        let what = "`nominal.model` is \"none\", and a model that predicts nothing lacks everything";
        let help = "write strain, polynomial or predicted, or leave the key out for what the manifest describes";
        let key = ["nominal".to_string(), "model".to_string()];
        return Err(EvalError::Train(Box::new(source.complaint(&key, what, help)).into()));
    }
    Ok((config, source, folder))
}

fn out(args: &CloseArgs, folder: &Path) -> PathBuf {
    let name = || {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
        let name = match &args.config {
            Some(file) => file.file_stem().map(ToOwned::to_owned),
            None => folder.file_name().map(ToOwned::to_owned),
        };
        name.map_or("data".into(), |name| name.to_string_lossy().into_owned())
    };
    args.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("loop-{}", name())))
}

fn case(config: &LoopConfig, source: &Source, campaign: &Campaign) -> Result<Recordings, EvalError> {
    let choice = choose(&config.nominal, source, campaign)?;
    let own = choice.spec().is_none();
    recordings(campaign, choice.spec().cloned().unwrap_or_else(|| campaign.nominal_spec()), own)
}

fn closed(given: Recordings, config: &LoopConfig, campaign: &Campaign) -> Result<Closed, EvalError> {
    let manifest = &campaign.manifest;
    let about = About {
        data: Data {
            name: manifest.name.clone(),
            title: manifest.title.clone(),
            hash: campaign.hash.clone(),
            synthetic: manifest.synthetic,
            calibration: vec![],
            development: vec![],
            untouched: vec![],
        },
        configuration: serde_json::to_value(config).map_err(|error| EvalError::Usage(error.to_string()))?,
        version: env!("CARGO_PKG_VERSION").into(),
        cautions: given.cautions,
    };
    let steps = Steps::new(&given.case.rig);
    steps.begin("calibrating the nominal model, and looking at what it misses");
    let closed = close(given.case, about, &config.options(), |step| steps.accepted(step));
    steps.end();
    closed.map_err(|error| {
        EvalError::Data(format!(
            "{}: the nominal model cannot be calibrated: {error}; choose another [nominal] model (strain, polynomial, \
             predicted), or give more calibration trials",
            manifest.name
        ))
    })
}
