//! Kills runs at random moments, resumes them with other numbers of jobs and threads, and holds every file against a run
//! that nobody disturbed.
//!
//! ```text
//! cargo run -p acm-train --example kills -- [--kills 200] [--kind cfc] [--signal kill|term|mixed] [--seed N]
//! ```
//!
//! Kinds: mlp, gru, cfc (these where none is named), ridge, boosted_trees, ablation, sweep, sequences.

#[path = "../tests/campaign/mod.rs"]
mod campaign;
#[path = "../tests/faults/mod.rs"]
mod faults;

use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use faults::{
    kills::{Signals, kill},
    questions::{NETWORKS, OTHERS, Question},
};

#[derive(Parser)]
struct Asked {
    /// Runs that are killed, of each kind
    #[arg(long, default_value_t = 200)]
    kills: usize,
    /// One kind of question; may be repeated
    #[arg(long)]
    kind: Vec<String>,
    /// How they are ended
    #[arg(long, value_enum, default_value_t = Signal::Kill)]
    signal: Signal,
    /// Of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Clone, Copy, ValueEnum)]
enum Signal {
    Kill,
    Term,
    Mixed,
}

fn main() -> ExitCode {
    let asked = Asked::parse();
    let signals = match asked.signal {
        Signal::Kill => Signals::Kill,
        Signal::Term => Signals::Term,
        Signal::Mixed => Signals::Mixed,
    };
    let known = || NETWORKS.into_iter().chain(OTHERS);
    if let Some(unknown) = asked.kind.iter().find(|kind| known().all(|name| name != kind.as_str())) {
        eprintln!("there is no kind {unknown}; there are {}", known().collect::<Vec<_>>().join(", "));
        return ExitCode::from(2);
    }
    let wanted = |name: &&str| match asked.kind.is_empty() {
        true => NETWORKS.contains(name),
        false => asked.kind.iter().any(|kind| kind == name),
    };
    let program = campaign::program();
    let (mut same, mut runs) = (0, 0);
    for name in known().filter(wanted) {
        let outcome = kill(&Question::new(name), &program, asked.kills, signals, asked.seed);
        outcome.faults.iter().for_each(|fault| println!("{fault}"));
        let [before, between, after] = outcome.moments;
        println!(
            "{name}: {} of {} killed runs ended in the same bits ({} kills: {before} before the first checkpoint or \
             record, {between} before the first record, {after} after it)",
            outcome.same, outcome.runs, outcome.kills
        );
        (same, runs) = (same + outcome.same, runs + outcome.runs);
    }
    println!("{same} of {runs} killed runs ended in the same bits");
    if same == runs { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
