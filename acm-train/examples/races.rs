//! Starts several processes at once on one run folder, again and again: one is to win, the others are to say who.
//!
//! ```text
//! cargo run -p acm-train --example races -- [--count 100]
//! ```

#[path = "../tests/campaign/mod.rs"]
mod campaign;
#[path = "../tests/faults/mod.rs"]
mod faults;

use std::process::ExitCode;

use clap::Parser;
use faults::{
    questions::Question,
    races::{RUNNERS, races},
};

#[derive(Parser)]
struct Asked {
    /// Races
    #[arg(long, default_value_t = 100)]
    count: usize,
}

fn main() -> ExitCode {
    let asked = Asked::parse();
    let outcome = races(&Question::new("gru"), &campaign::program(), asked.count);
    outcome.faults.iter().for_each(|fault| println!("{fault}"));
    if outcome.late > 0 {
        println!("{} races repeated: a process came after the winner's end", outcome.late);
    }
    println!("{} of {} races of {RUNNERS} processes had one winner each", outcome.clean, outcome.races);
    if outcome.clean == outcome.races { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
