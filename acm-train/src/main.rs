//! `acm-train`: one experiment file in, one run folder out.

use std::{
    io::{Write, stderr, stdout},
    process::ExitCode,
};

use acm_train::{cli::Cli, job};
use clap::Parser;
use miette::{MietteHandlerOpts, Report};

fn main() -> ExitCode {
    // A closed pipe ends the program and is no failure.
    sigpipe::reset();
    let cli = Cli::parse();
    // Messages are not wrapped, so that a path or a value can be searched for in a log, and name their cause themselves.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).without_cause_chain().build())
    }));
    match job::conduct(&cli) {
        Ok(table) => {
            // A reader that went away (`acm-train … | head`) is no failure of the run.
            let _ = writeln!(stdout(), "{table}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            let code = error.exit_code();
            let _ = writeln!(stderr(), "{:?}", Report::new(error));
            ExitCode::from(code)
        }
    }
}
