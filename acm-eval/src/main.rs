//! `acm-eval`: judges runs from their records, and closes the loop with recordings.

mod commands;

use std::process::ExitCode;

use acm_eval::error::EvalError;
use clap::{Parser, Subcommand};
use commands::{report, score_loop};

/// Judges models: compares runs of acm-train, and traces what a model misses to a physical effect.
#[derive(Parser)]
#[command(version, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compares runs on one self-contained page, with figures (SVG, PNG) and tables (CSV) beside it
    #[command(after_help = report::EXAMPLES)]
    Report(report::ReportArgs),
    /// Scores close-loop on synthetic campaigns whose truth is sealed: top-1, false alarms, coverage, …
    #[command(after_help = score_loop::EXAMPLES)]
    ScoreLoop(score_loop::ScoreArgs),
}

const EXIT_CODES: &str = "Exit codes: 0 done; 2 usage or configuration; 3 data, or records that cannot be compared; 4 file system; 5 the output \
     folder is in use.";

fn main() -> ExitCode {
    match run(&Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(command: &Command) -> Result<(), EvalError> {
    match command {
        Command::Report(args) => report::run(args),
        Command::ScoreLoop(args) => score_loop::run(args),
    }
}
