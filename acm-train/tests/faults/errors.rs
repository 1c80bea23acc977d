//! The N-th write, fsync or rename of a run fails with EIO: it ends with code 4 and a path, and resumed in the same bits.
//!
//! `strace` puts the errors in. It counts the calls of each thread by itself, so that the N-th of several threads may fail in
//! one run; every call of every thread is met by some N.

use std::{
    collections::BTreeMap,
    fs,
    path::Path,
    process::{Command, Output},
};

use crate::faults::{kills::Undisturbed, questions::Question};

/// Calls by which a file comes to be.
pub const CALLS: [&str; 3] = ["write", "fsync", "rename"];

/// At most so often does the same call fail before a run is left alone.
const TIMES: usize = 3;

/// What became of the runs.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Runs in which a call failed.
    pub runs: usize,
    /// Runs that said so with code 4 and a path, or did without what failed, and ended in the same bits when resumed.
    pub sound: usize,
    /// Of these, runs that did without: a line of progress that could not be shown.
    pub unneeded: usize,
    /// Each run that was not.
    pub faults: Vec<String>,
}

/// Whether there is a tracer that may trace.
pub fn can_trace() -> bool {
    let traced = Command::new("strace").args(["-f", "-qq", "-o", "/dev/null", "true"]).status();
    traced.is_ok_and(|status| status.success())
}

/// Lets every `step`-th call fail, from the first to the last of a run without errors.
pub fn sweep(question: &Question, program: &Path, step: usize) -> Outcome {
    let undisturbed = Undisturbed::new(question, program);
    let mut outcome = Outcome::default();
    for call in CALLS {
        for nth in (1..=count(question, program, call)).step_by(step) {
            outcome.runs += 1;
            match one(question, program, call, nth, &undisturbed) {
                Ok(needed) => {
                    outcome.sound += 1;
                    outcome.unneeded += usize::from(!needed);
                }
                Err(fault) => outcome.faults.push(format!("{call} number {nth}: {fault}")),
            }
        }
    }
    outcome
}

/// The largest number of such calls of one thread.
fn count(question: &Question, program: &Path, call: &str) -> usize {
    let options = ["-o", "trace", "-e", &format!("trace={call}")];
    assert!(traced(question, program, "counted", &options).status.success());
    let trace = fs::read_to_string(question.path("trace")).unwrap();
    fs::remove_dir_all(question.path("counted")).unwrap();
    let mut calls: BTreeMap<&str, usize> = BTreeMap::new();
    for line in trace.lines().filter(|line| line.contains(&format!("{call}("))) {
        *calls.entry(line.split_whitespace().next().unwrap_or_default()).or_default() += 1;
    }
    calls.into_values().max().unwrap_or(0)
}

/// Whether the run needed what failed. A failure in one thread keeps the later ones from their N-th call: so the same is done
/// to the resumed run, a few times, before it may come to its end.
fn one(question: &Question, program: &Path, call: &str, nth: usize, undisturbed: &Undisturbed) -> Result<bool, String> {
    let out = format!("{call}-{nth}");
    let inject = format!("inject={call}:error=EIO:when={nth}");
    let options = ["-o", "/dev/null", "-e", &format!("trace={call}"), "-e", &inject];
    let (mut ended, mut failures) = (None, 0);
    while ended.is_none() && failures < TIMES {
        let output = traced(question, program, &out, &options);
        let told = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(4) if (told.contains(&out) || told.contains("standard output")) && !told.contains("panicked") => {
                failures += 1;
            }
            Some(0) => ended = Some(output),
            code => return Err(format!("it ended with {code:?}: {told}")),
        }
    }
    // A line of progress that cannot be shown is no reason to end; anything else is.
    if failures == 0 && call != "write" {
        return Err("nobody noticed".into());
    }
    let ended = ended.unwrap_or_else(|| question.command(program, &out, &["--resume"]).output().unwrap());
    if !ended.status.success() {
        return Err(format!("resumed, it ended with {}", String::from_utf8_lossy(&ended.stderr)));
    }
    undisturbed.compare(question, &out, &String::from_utf8_lossy(&ended.stdout))?;
    fs::remove_dir_all(question.path(&out)).unwrap();
    Ok(failures > 0)
}

fn traced(question: &Question, program: &Path, out: &str, options: &[&str]) -> Output {
    let run = question.command(program, out, &["--resume", "--jobs", "1", "--threads", "1"]);
    let mut command = Command::new("strace");
    command.args(["-f", "-qq"]).args(options).arg(run.get_program()).args(run.get_args());
    command.current_dir(question.path("")).output().unwrap()
}
