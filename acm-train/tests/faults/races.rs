//! Several processes that want the same run folder at the same moment: one works, the others say who it is.
//!
//! Oracle: a run that nobody disturbed; and the numbers that the operating system gave the processes.

use std::{
    fs,
    path::Path,
    process::{Child, Output, Stdio},
};

use crate::faults::{kills::Undisturbed, questions::Question};

/// Processes that start at the same time.
pub const RUNNERS: usize = 4;

/// What became of the races.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Races with one winner, and losers that name it.
    pub clean: usize,
    /// All races.
    pub races: usize,
    /// Races that were repeated, since a process came when the winner had finished already.
    pub late: usize,
    /// Each race that was not clean.
    pub faults: Vec<String>,
}

/// Holds `count` races.
pub fn races(question: &Question, program: &Path, count: usize) -> Outcome {
    let undisturbed = Undisturbed::new(question, program);
    let mut outcome = Outcome::default();
    while outcome.races < count {
        let out = format!("race-{}", outcome.races);
        let result = race(question, program, &out, &undisturbed);
        fs::remove_dir_all(question.path(&out)).unwrap();
        match result {
            Ok(false) => {
                outcome.late += 1;
                assert!(outcome.late < 10 * count + 10, "the machine is too slow for races");
                continue;
            }
            Ok(true) => outcome.clean += 1,
            Err(fault) => outcome.faults.push(format!("{out}: {fault}")),
        }
        outcome.races += 1;
    }
    outcome
}

/// Whether all came before the winner had finished; an error if the race was not clean.
fn race(question: &Question, program: &Path, out: &str, undisturbed: &Undisturbed) -> Result<bool, String> {
    let start = |_| {
        let mut command = question.command(program, out, &["--threads", "1"]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let runners: Vec<Child> = (0..RUNNERS).map(start).collect();
    let ended: Vec<(u32, Output)> =
        runners.into_iter().map(|child| (child.id(), child.wait_with_output().unwrap())).collect();
    let told = |output: &Output| String::from_utf8_lossy(&output.stderr).into_owned();
    let winners: Vec<&(u32, Output)> = ended.iter().filter(|(_, output)| output.status.success()).collect();
    let [(winner, output)] = winners[..] else {
        let all: Vec<String> = ended.iter().map(|(_, o)| format!("{:?}: {}", o.status.code(), told(o))).collect();
        return Err(format!("{} winners: {}", winners.len(), all.join("\n")));
    };
    undisturbed.compare(question, out, &String::from_utf8_lossy(&output.stdout))?;
    let losers = || ended.iter().filter(|(id, _)| id != winner).map(|(_, loser)| (loser.status.code(), told(loser)));
    // Who came after the end held the folder for a moment, and may be the one that another loser names.
    if losers().any(|(code, told)| code == Some(2) && told.contains("already holds a run")) {
        return Ok(false);
    }
    for (code, told) in losers() {
        if code != Some(5) || !told.contains(&format!("process {winner} ")) || !told.contains(out) {
            return Err(format!("process {winner} won, and a loser ended with {code:?}: {told}"));
        }
    }
    Ok(true)
}
