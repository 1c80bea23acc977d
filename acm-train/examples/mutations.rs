//! Mutates checkpoints, records and tables of real runs, and has them read: each is to be refused by its name.
//!
//! ```text
//! cargo run -p acm-train --example mutations -- [--count 10000] [--seed N]
//! ```

#[path = "../tests/campaign/mod.rs"]
mod campaign;
#[path = "../tests/faults/mod.rs"]
mod faults;

use std::process::ExitCode;

use clap::Parser;
use faults::{mutations::mutate, saved};

#[derive(Parser)]
struct Asked {
    /// Mutated files
    #[arg(long, default_value_t = 10_000)]
    count: usize,
    /// Of the mutations
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    let asked = Asked::parse();
    let outcome = mutate(&saved::all(&campaign::program()), asked.count, asked.seed);
    outcome.faults.iter().take(20).for_each(|fault| println!("{fault}"));
    for (kind, count) in &outcome.kinds {
        println!("{kind}: {count}");
    }
    println!(
        "{} of {} mutated files were refused by their names: {} panics, {} silent accepts, {} accepts of equal content",
        outcome.refused, outcome.files, outcome.panics, outcome.silent, outcome.equal
    );
    if outcome.refused == outcome.files { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
