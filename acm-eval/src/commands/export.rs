//! `acm-eval export`: a trained network for other programs.

use std::path::{Path, PathBuf};

use acm_datasets::files::{atomic, regular};
use acm_eval::{error::EvalError, terminal::print};
use acm_export::{ExportError, File, Origin, c99, onnx, torch};
use acm_stream::Parts;
use clap::Args;

use acm_eval::stream::saved::{Request, load};

/// Above the options, in full.
pub const ABOUT: &str = "\
Writes a trained network for other programs: C99, ONNX, PyTorch

C99 holds the whole estimator: nominal model, effects, scalers and network, for a flight controller. ONNX and PyTorch hold \
the network's step with its scalers, and the nominal model stays outside. Beside each lie recorded inputs and answers, with \
a test of the export against them.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval export runs/cfc --c99 firmware/arm
      estimator.h and estimator.c; `cc -std=c99 -DSELFTEST estimator.c && ./a.out` runs the recorded vectors
  acm-eval export runs/cfc --c99 out --onnx out --torch out --name arm
      All three in one folder; arm_onnx_check.py and arm_torch.py check theirs when they are run
  acm-eval export robot.json --onnx out
      From a file that `acm-eval stream RUN --save robot.json` wrote; neither the run nor its data are needed

A part that C cannot hold yet is refused by its name, with what to do instead; nothing is left out.

Exit codes: 0 written; 2 usage, or a part that cannot be written; 3 data; 4 file system.";

/// What may be asked for.
#[derive(Args)]
pub struct ExportArgs {
    /// Run folder, such as runs/cfc, or a file that `acm-eval stream RUN --save FILE` wrote
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

/// One kind of export.
type Export = fn(&Parts, &Origin) -> Result<Vec<File>, ExportError>;

/// Writes every export that is asked for, and says which files it wrote.
pub fn run(args: &ExportArgs) -> Result<(), EvalError> {
    let (parts, source) = estimator(args)?;
    let origin = Origin { name: args.name.clone(), source, recorded: args.recorded.map(|count| count as usize) };
    let asked: [(&Option<PathBuf>, Export); 3] =
        [(&args.c99, c99::export), (&args.onnx, onnx::export), (&args.torch, torch::export)];
    for (folder, export) in asked {
        let Some(folder) = folder else { continue };
        let refused = |error: ExportError| EvalError::Usage(format!("{}: {error}", args.run.display()));
        for File { path, bytes } in export(&parts, &origin).map_err(refused)? {
            let path = folder.join(path);
            atomic::write_bytes(&path, &bytes).map_err(EvalError::Table)?;
            print(&path.display().to_string())?;
        }
    }
    Ok(())
}

/// Returns the estimator, and where it came from in one line.
fn estimator(args: &ExportArgs) -> Result<(Parts, String), EvalError> {
    if args.run.is_file() {
        return Ok((saved(&args.run)?, args.run.display().to_string()));
    }
    let (id, data) = (args.network.as_deref(), args.data.as_deref());
    let saved = load(&Request { run: &args.run, id, data, windows: args.windows })?;
    Ok((saved.parts, format!("{} of {}: {}", saved.id, args.run.display(), saved.title)))
}

fn saved(file: &Path) -> Result<Parts, EvalError> {
    let bytes = regular::read(file).map_err(|error| EvalError::Data(format!("{}: {error}", file.display())))?;
    Parts::from_json(&bytes).map_err(|error| EvalError::Data(format!("{}: {error}", file.display())))
}
