//! `acm-data`: inspects, checks and generates data sets.

mod commands;

use std::ffi::OsString;
use std::io::{ErrorKind, Write, stderr, stdout};
use std::path::PathBuf;
use std::process::ExitCode;

use acm_datasets::DataError;
use acm_datasets::toml_file::words::{LONGEST, cut};
use acm_sim::small_rigs::Kind as Rig;
use acm_sim::twin::undeclared::{Design, Kind};
use clap::{Args, Parser, Subcommand};

/// Checks, describes and makes data sets: folders with a manifest.toml and recordings.
///
/// Exit codes: 0 all is well, 2 usage or manifest, 3 data, 4 file system, 5 folder in use.
#[derive(Parser)]
#[command(name = "acm-data", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Read a data set and print everything that is wrong with it.
    ///
    /// Example: acm-data check my-robot
    Check {
        #[command(flatten)]
        set: Set,
        /// Samples of the longest window; shorter development and held-out trials are problems.
        #[arg(long, default_value_t = 50, value_parser = at_least_one)]
        window: usize,
    },
    /// Print trials, durations, rates, gaps and ranges, and draw them; of several sources also their clocks.
    ///
    /// Example: acm-data describe datasets/acm-twin
    Describe {
        #[command(flatten)]
        set: Set,
        /// Also draw the signals of several sources on the common clock, as SVG into this file.
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
    },
    /// Make the synthetic flight campaign, or one with an undeclared effect. The same seed gives the same bytes.
    #[command(after_help = GENERATE)]
    Generate {
        /// Folder of the new data set; acm-twin or undeclared-SEED where it is omitted.
        #[arg(long)]
        out: Option<PathBuf>,
        /// Seed of all random draws.
        #[arg(long, default_value_t = acm_sim::twin::SEED)]
        seed: u64,
        /// Also estimate the error floors that no estimator can beat; this takes a hundred times as long.
        #[arg(long, conflicts_with = "scale")]
        floors: bool,
        /// Repeat the campaign this many times with other seeds, in tables by trial; 1000 times take an hour on one core.
        #[arg(long, value_name = "TIMES", default_value_t = 1, value_parser = times)]
        scale: usize,
        /// A small campaign with an effect drawn by this seed: one, two, none, or one outside of the library. Only
        /// sealed/truth.json names it.
        #[arg(long, value_name = "SEED", conflicts_with_all = ["seed", "floors", "scale"])]
        undeclared: Option<u64>,
        /// How actuators and vehicle move in it: rich (speeds, steps and altitudes vary) or paper (they hardly do).
        #[arg(long, requires = "undeclared", default_value = "rich", value_parser = design)]
        design: Design,
        /// The mechanism, instead of a drawn one: backlash, backlash+creep, white, null+encoder, several1 to several6
        /// (that many effects, with further imperfections), …
        #[arg(long, requires = "undeclared", value_name = "NAME", value_parser = kind)]
        kind: Option<Kind>,
        /// A small rig of this kind instead, drawn by the same seed: joint_with_load, axis, heated_tank,
        /// hardening_spring, sheath, static_map_motor, six_joints.
        #[arg(long, requires = "undeclared", value_name = "KIND", value_parser = rig, conflicts_with_all = ["kind", "design"])]
        small_rig: Option<Rig>,
    },
    /// Print the statistics of a synthetic campaign beside those of the paper.
    ///
    /// Example: acm-data statistics datasets/acm-twin
    Statistics {
        /// Folder with manifest.toml.
        #[arg(default_value = "datasets/acm-twin")]
        folder: PathBuf,
        /// Folder with the data files, where they are not beside the manifest.
        #[arg(long)]
        data: Option<PathBuf>,
    },
    /// Look at a folder of recordings and write a first manifest, with questions as comments.
    ///
    /// Example: acm-data init my-robot
    Init {
        /// Folder with the recordings.
        folder: PathBuf,
    },
    /// Bring the sources of each trial to one clock, and write the trials as Parquet tables.
    ///
    /// Example: acm-data join my-robot --out joined
    Join {
        #[command(flatten)]
        set: Set,
        /// Folder of the tables, of a manifest for them, and of clocks.txt.
        #[arg(long)]
        out: PathBuf,
    },
    /// Predict the outputs with a nominal model of your own, and write the recordings with its predictions.
    ///
    /// The program is started for each trial. It reads a header and a line for each sample, as CSV: `time` in s, then actuators, contexts and
    /// conditions in the units of the manifest. It prints a line for each: one number an output, in its unit.
    ///
    /// Example: acm-data predict my-robot --out predicted -- python3 my_model.py
    Predict {
        #[command(flatten)]
        set: Set,
        /// Folder of the new data set, which has the predictions as `[[predicted]]` columns.
        #[arg(long)]
        out: PathBuf,
        /// The program with its arguments, behind `--`.
        #[arg(last = true, required = true)]
        program: Vec<OsString>,
    },
}

/// Below the options of `generate`.
const GENERATE: &str = "\
Examples:
  acm-data generate --out my-twin --seed 11
  acm-data generate --out large-twin --scale 100
  acm-data generate --undeclared 7 --design paper
  acm-data generate --undeclared 14001 --kind several3
  acm-data generate --undeclared 14001 --small-rig axis";

/// Which data set.
#[derive(Args)]
struct Set {
    /// Folder with manifest.toml.
    folder: PathBuf,
    /// Folder with the data files, where they are not beside the manifest.
    #[arg(long)]
    data: Option<PathBuf>,
    /// A longer step in time is a gap, s [default: five usual steps of the trial, at least 0.5 s]
    #[arg(long, value_parser = positive)]
    max_gap: Option<f64>,
}

fn main() -> ExitCode {
    let mut text = String::new();
    acm_datasets::files::limits::ignore_sigxfsz();
    let done = run(Cli::parse().command, &mut text);
    let printed = print(&text);
    match done.and(printed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(stderr(), "error: {}", cut(error.to_string().trim_end(), LONGEST));
            ExitCode::from(error.exit_code())
        }
    }
}

/// A closed pipe, as of `acm-data describe … | head`, is no failure; a disk that is full is one.
fn print(text: &str) -> Result<(), DataError> {
    match stdout().write_all(text.as_bytes()).and_then(|()| stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(DataError::file_system("write", "standard output", &error))
        }
        _ => Ok(()),
    }
}

fn run(command: Command, text: &mut String) -> Result<(), DataError> {
    match command {
        Command::Check { set, window } => commands::check::run(&set, window, text),
        Command::Describe { set, picture } => commands::describe::run(&set, picture.as_deref(), text),
        Command::Generate { out, undeclared: Some(seed), small_rig: Some(kind), .. } => {
            let folder = out.unwrap_or_else(|| format!("{}-{seed}", kind.name()).into());
            commands::generate::small_rig(&folder, seed, kind, text)
        }
        Command::Generate { out, undeclared: Some(seed), design, kind, .. } => {
            let folder = out.unwrap_or_else(|| format!("undeclared-{seed}").into());
            commands::generate::undeclared(&folder, seed, design, kind, text)
        }
        Command::Generate { out, seed, floors, scale: 1, .. } => {
            commands::generate::run(&out.unwrap_or_else(|| "acm-twin".into()), seed, floors, text)
        }
        Command::Generate { out, seed, scale, .. } => {
            let folder = out.unwrap_or_else(|| format!("acm-twin-{scale}").into());
            commands::generate::repeated(&folder, seed, scale, text)
        }
        Command::Statistics { folder, data } => commands::statistics::run(&folder, data.as_ref(), text),
        Command::Init { folder } => commands::init::run(&folder, text),
        Command::Join { set, out } => commands::join::run(&set, &out, text),
        Command::Predict { set, out, program } => commands::predict::run(&set, &out, &program, text),
    }
}

fn design(text: &str) -> Result<Design, String> {
    Design::ALL.into_iter().find(|design| design.name() == text).ok_or_else(|| "choose rich or paper".into())
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = || Kind::all().into_iter().map(Kind::name).collect::<Vec<String>>().join(" ");
    Kind::find(name).ok_or_else(|| format!("there is no such kind; known: {}", known()))
}

fn rig(name: &str) -> Result<Rig, String> {
    let known = || Rig::ALL.map(Rig::name).join(" ");
    Rig::find(name).ok_or_else(|| format!("there is no such kind of rig; known: {}", known()))
}

fn times(text: &str) -> Result<usize, String> {
    let most = acm_datasets::generate::large::MOST;
    text.parse()
        .ok()
        .filter(|times| (1..=most).contains(times))
        .ok_or_else(|| format!("give a number from 1 to {most}"))
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("give at least 1".into()),
        Ok(count) => Ok(count),
        Err(_) => Err("give a whole number".into()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("give a finite number above 0".into()),
    }
}
