//! `acm-train`: one experiment file in, one run folder out.

use std::{
    io::{ErrorKind, Write, stderr, stdout},
    process::ExitCode,
};

use acm_train::{
    TrainError,
    cli::{Cli, conduct},
    explain,
    store::StoreError,
};
use clap::Parser;

fn main() -> ExitCode {
    acm_datasets::files::limits::ignore_sigxfsz();
    let cli = Cli::parse();
    match conduct(&cli).and_then(|table| print(&table)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let code = error.exit_code();
            let _ = writeln!(stderr(), "{}", explain(error));
            ExitCode::from(code)
        }
    }
}

/// Prints the table. A reader that went away (`acm-train … 2>&1 | head -1`) is no failure of the run, which continues
/// to its end; a disk that is full is one.
fn print(table: &str) -> Result<(), TrainError> {
    match writeln!(stdout(), "{table}").and_then(|()| stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(StoreError::io("write", "standard output", error).into())
        }
        _ => Ok(()),
    }
}
