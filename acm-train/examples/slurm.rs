//! Starts a Slurm on the loopback of this machine, has it conduct a sweep of 24 runs while tasks, controller and caller are
//! killed, and holds the result against the same sweep without Slurm.
//!
//! ```text
//! cargo run -p acm-train --example slurm -- [--count 1]
//! ```

#[path = "../tests/campaign/mod.rs"]
mod campaign;
#[path = "../tests/slurm/mod.rs"]
mod slurm;

use std::process::ExitCode;

use clap::Parser;
use slurm::{
    loopback::Loopback,
    sweep::{RUNS, sweep},
};

#[derive(Parser)]
struct Asked {
    /// Times
    #[arg(long, default_value_t = 1)]
    count: usize,
}

fn main() -> ExitCode {
    let (mut records, mut faults) = (0, 0);
    let count = Asked::parse().count;
    for _ in 0..count {
        let Some(mut slurm) = Loopback::start() else { return ExitCode::FAILURE };
        let outcome = sweep(&mut slurm);
        records += outcome.records;
        faults += outcome.faults.len();
        outcome.faults.iter().for_each(|fault| println!("{fault}"));
    }
    let tables = if faults == 0 { "tables equal" } else { "and what differs is above" };
    println!("{records} of {} records, {tables}", RUNS * count);
    if faults == 0 && records == RUNS * count { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
