//! `acm-eval export`: an estimator for other programs.

mod given;

use std::path::{Path, PathBuf};

use acm_datasets::files::{atomic, owned};
use acm_eval::stream::saved::Request;
use acm_eval::{error::EvalError, ownership, terminal::print};
use acm_export::{ExportError, File, Origin};
use clap::Args;

use given::Given;

/// Above the options, in full.
pub const ABOUT: &str = "\
Writes an estimator for other programs: C99, ONNX, PyTorch

C99 holds the whole estimator, for a flight controller: nominal model with its effects, with a network on top or without one, or the \
average of several of these. ONNX and PyTorch hold the step of one network with its scalers, and the nominal model stays outside. \
Beside each lie recorded inputs and answers, with a test of the export against them.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval export runs/cfc --c99 firmware/arm
      estimator.h and estimator.c; `cc -std=c99 -DSELFTEST estimator.c && ./a.out` runs the recorded vectors
  acm-eval export runs/loop-my-robot --c99 firmware/arm
      What close-loop found: the nominal model with its effects, without a network; model.json itself will do, too
  acm-eval export runs/best --c99 firmware/arm
      The winner of a study of the best model, an average of several models if it is one
  acm-eval export runs/cfc --c99 out --onnx out --torch out --name arm
      All three in one folder; arm_onnx_check.py and arm_torch.py check theirs when they are run
  acm-eval export robot.json --onnx out
      From a file that `acm-eval stream RUN --save robot.json` wrote; neither the run nor its data are needed

The header names inputs and outputs as the manifest does, each with the SI unit that the functions take and the manifest's own.
A part that C cannot hold is refused by its name, with what to do instead; nothing is left out. Files that an earlier export
wrote under the same names are replaced, and no others.

Exit codes: 0 written; 2 usage, or a part that cannot be written; 3 data; 4 file system.";

/// What may be asked for.
#[derive(Args)]
pub struct ExportArgs {
    /// Run folder, such as runs/cfc; folder of a study = "best" or of a closed loop; model.json, or a file of `acm-eval stream --save`
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Write C99 into this folder: one header and one source
    #[arg(long, value_name = "DIR", required_unless_present_any = ["onnx", "torch"])]
    c99: Option<PathBuf>,
    /// Write an ONNX model of the network's step into this folder
    #[arg(long, value_name = "DIR")]
    onnx: Option<PathBuf>,
    /// Write parameters and a module of PyTorch into this folder
    #[arg(long, value_name = "DIR")]
    torch: Option<PathBuf>,
    /// Name of files, and of what they define
    #[arg(long, value_name = "NAME", default_value = "estimator")]
    name: String,
    /// Samples that are recorded for the check beside each export [default: 120 in C99, 300 elsewhere]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    recorded: Option<u64>,
    /// Which network of the run, such as final-seed1 [default: of the final ones that with the smallest validation loss]
    #[arg(long, value_name = "ID")]
    network: Option<String>,
    /// In C, give the network a window of samples for each answer, as it was scored
    #[arg(long)]
    windows: bool,
    /// Folder with the tables of the run's data set, where they do not lie beside its manifest
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

/// A kind of export: its name, its folder, and what writes it.
type Kind<'a> = (&'static str, &'a Option<PathBuf>, Export);

/// Function that writes an export.
type Export = fn(&Given, &Origin) -> Result<Vec<File>, ExportError>;

/// Writes every export that is asked for, and says which files it wrote.
pub fn run(args: &ExportArgs) -> Result<(), EvalError> {
    let kinds: [Kind; 3] = [("C99", &args.c99, c99), ("ONNX", &args.onnx, onnx), ("PyTorch", &args.torch, torch)];
    let asked = || kinds.iter().filter_map(|(name, folder, export)| Some((*name, folder.as_deref()?, export)));
    asked().try_for_each(|(_, folder, _)| refuse_data_set(folder))?;
    let (id, data) = (args.network.as_deref(), args.data.as_deref());
    let given = Given::read(&Request { run: &args.run, id, data, windows: args.windows })?;
    let (name, source) = (args.name.clone(), given.source.clone());
    let origin = Origin { name, source, recorded: args.recorded.map(|count| count as usize) };
    let mut files = vec![];
    for (name, folder, export) in asked() {
        refuse_several(args, &given, name)?;
        let refused = |error: ExportError| EvalError::Usage(format!("{}: {error}", args.run.display()));
        let written = export(&given, &origin).map_err(refused)?;
        files.extend(written.into_iter().map(|file| (folder.join(&file.path), file)));
    }
    let own = |(path, file): &(PathBuf, File)| owned::claim(path, |head| file.is_earlier(head));
    files.iter().try_for_each(own).map_err(EvalError::Table)?;
    for (path, file) in files {
        atomic::write_bytes(&path, &file.bytes).map_err(EvalError::Table)?;
        print(&path.display().to_string())?;
    }
    Ok(())
}

fn c99(given: &Given, origin: &Origin) -> Result<Vec<File>, ExportError> {
    match given.average.members.as_slice() {
        [one] => acm_export::c99::export(&one.parts, origin),
        _ => acm_export::c99::export_average(&given.average, origin),
    }
}

fn onnx(given: &Given, origin: &Origin) -> Result<Vec<File>, ExportError> {
    acm_export::onnx::export(&given.average.members[0].parts, origin)
}

fn torch(given: &Given, origin: &Origin) -> Result<Vec<File>, ExportError> {
    acm_export::torch::export(&given.average.members[0].parts, origin)
}

/// Refuses a folder that is a data set, or lies in one: recordings stay among themselves.
fn refuse_data_set(folder: &Path) -> Result<(), EvalError> {
    let Some(set) = ownership::data_set(folder) else { return Ok(()) };
    Err(EvalError::Usage(format!(
        "{}: {} is a data set, in which nothing but recordings is written; give the export a folder of its own",
        folder.display(),
        set.display()
    )))
}

/// Refuses an average in a format that holds one network; names the networks that can be exported.
fn refuse_several(args: &ExportArgs, given: &Given, format: &str) -> Result<(), EvalError> {
    let count = given.average.members.len();
    if count == 1 || format == "C99" {
        return Ok(());
    }
    let option = if format == "ONNX" { "--onnx" } else { "--torch" };
    let command = |(folder, id): &(PathBuf, String)| {
        format!("`acm-eval export {} --network {id} {option} DIR`", folder.display())
    };
    let each = match given.networks.as_slice() {
        [] => "export the run folders of its networks one by one".into(),
        networks => {
            format!("export its networks one by one: {}", networks.iter().map(command).collect::<Vec<_>>().join(", "))
        }
    };
    Err(EvalError::Usage(format!(
        "{}: an average of {count} estimators cannot be written as {format}, which holds the step of one network; {each}; or write \
         the average as C99: --c99 DIR",
        args.run.display()
    )))
}
