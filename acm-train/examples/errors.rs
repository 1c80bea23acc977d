//! Lets the N-th write, fsync and rename of a run fail with EIO, for every N: code 4 with a path, and resumed the same bits.
//!
//! ```text
//! cargo run -p acm-train --example errors -- [--step 1]
//! ```
//!
//! Linux, with `strace`.

#[path = "../tests/campaign/mod.rs"]
mod campaign;
#[path = "../tests/faults/mod.rs"]
mod faults;

use std::process::ExitCode;

use clap::Parser;
use faults::{
    errors::{can_trace, sweep},
    questions::Question,
};

#[derive(Parser)]
struct Asked {
    /// Every so many calls
    #[arg(long, default_value_t = 1)]
    step: usize,
}

fn main() -> ExitCode {
    let asked = Asked::parse();
    if !can_trace() {
        eprintln!("strace is missing, or may not trace here");
        return ExitCode::from(2);
    }
    let outcome = sweep(&Question::new("gru"), &campaign::program(), asked.step.max(1));
    outcome.faults.iter().for_each(|fault| println!("{fault}"));
    println!(
        "{} of {} runs with a failing write, fsync or rename named it and were resumed to the same bits ({} did without it)",
        outcome.sound, outcome.runs, outcome.unneeded
    );
    if outcome.sound == outcome.runs { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
