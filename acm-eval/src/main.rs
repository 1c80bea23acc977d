//! `acm-eval`: judges runs from their records, and closes the loop with recordings.

mod commands;

use std::{
    io::{Write, stderr},
    process::ExitCode,
};

use acm_datasets::text::help::help;
use acm_eval::{error::EvalError, question};
use acm_train::explain;
use clap::{Parser, Subcommand};
use commands::{close_loop, export, import, report, score_loop, separability, stream};
use mimalloc::MiMalloc;

#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// Judges models: compares runs of acm-train, and traces what a model misses to a physical effect.
#[derive(Parser)]
#[command(version, after_help = help(EXIT_CODES), max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Finds the physical effect that a nominal model lacks, and reports the error before and after
    #[command(long_about = close_loop::ABOUT, after_help = help(close_loop::EXAMPLES))]
    CloseLoop(question::Asked),
    /// Writes an estimator for other programs: C99, ONNX, PyTorch
    #[command(long_about = export::ABOUT, after_help = help(export::EXAMPLES))]
    Export(export::ExportArgs),
    /// Scores a network that was trained elsewhere: in PyTorch, by the names of torch and ncps
    #[command(long_about = import::ABOUT, after_help = help(import::EXAMPLES))]
    Import(import::ImportArgs),
    /// Compares runs and studies on one self-contained page, with figures (SVG, PNG) and tables (CSV, LaTeX) beside it
    #[command(after_help = help(report::EXAMPLES))]
    Report(report::ReportArgs),
    /// Scores close-loop on synthetic campaigns whose truth is sealed: top-1, false alarms, coverage, …
    #[command(after_help = help(score_loop::EXAMPLES))]
    ScoreLoop(score_loop::ScoreArgs),
    #[command(about = separability::ABOUT, after_help = help(separability::EXAMPLES))]
    Separability(question::Asked),
    /// Estimates the outputs sample by sample, from lines on standard input, with a trained network
    #[command(long_about = stream::ABOUT, after_help = help(stream::EXAMPLES))]
    Stream(stream::StreamArgs),
}

const EXIT_CODES: &str = "Exit codes: 0 done; 2 usage or configuration; 3 data, or records that cannot be compared; 4 file system; 5 the output \
     folder is in use; 130 stopped by Ctrl-C.";

fn main() -> ExitCode {
    // A closed pipe, as of `acm-eval score-loop | head`, ends the program and is no failure.
    sigpipe::reset();
    acm_datasets::files::limits::ignore_sigxfsz();
    match run(&Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let code = error.exit_code();
            show(error);
            ExitCode::from(code)
        }
    }
}

/// Shows an error. A fault of a configuration is shown in its place, as acm-train does.
fn show(error: EvalError) {
    match error {
        EvalError::Train(error) => drop(writeln!(stderr(), "{}", explain(error))),
        error => drop(writeln!(stderr(), "error: {error}")),
    }
}

fn run(command: &Command) -> Result<(), EvalError> {
    match command {
        Command::CloseLoop(args) => close_loop::run(args),
        Command::Export(args) => export::run(args),
        Command::Import(args) => import::run(args),
        Command::Report(args) => report::run(args),
        Command::ScoreLoop(args) => score_loop::run(args),
        Command::Separability(args) => separability::run(args),
        Command::Stream(args) => stream::run(args),
    }
}
