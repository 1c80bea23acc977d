//! Slurm's job arrays, on a real Slurm where it is installed, and on stand-ins of its programs for what it refuses.
#![cfg(unix)]

#[path = "../campaign/mod.rs"]
mod campaign;
#[path = "mod.rs"]
mod slurm;

mod refusals;
mod unattended;

use slurm::{
    loopback::Loopback,
    sweep::{RUNS, sweep},
};

/// Oracle: the same sweep on this machine, left in peace.
#[test]
fn a_sweep_whose_tasks_fail_ends_in_the_same_tables() {
    let Some(mut slurm) = Loopback::start() else { return };
    let outcome = sweep(&mut slurm);
    assert!(outcome.faults.is_empty(), "{}", outcome.faults.join("\n"));
    assert_eq!(outcome.records, RUNS);
}
