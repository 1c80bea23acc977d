//! Runs that are killed at random moments of their life and resumed with another number of jobs and threads.
//!
//! Oracle: a run of the same question that nobody disturbed, compared byte for byte, and what both print at the end.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::faults::{
    folder::{contents, difference},
    questions::Question,
};

/// At most so often is one run killed before it may end.
const MOST: usize = 3;

/// How a run is ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signals {
    /// SIGKILL, which no program can answer.
    Kill,
    /// SIGTERM, which asks to stop.
    Term,
    /// Either of both, as it comes.
    Mixed,
}

/// What became of the runs of one question.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Runs that were killed at least once, and ended in the same bits.
    pub same: usize,
    /// Runs that were killed at least once.
    pub runs: usize,
    /// All kills.
    pub kills: usize,
    /// Kills before the first file, while there was no finished run, and after.
    pub moments: [usize; 3],
    /// Each run that did not.
    pub faults: Vec<String>,
}

/// Kills `count` runs of a question.
pub fn kill(question: &Question, program: &Path, count: usize, signals: Signals, seed: u64) -> Outcome {
    let undisturbed = Undisturbed::new(question, program);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut outcome = Outcome::default();
    while outcome.runs < count {
        let out = format!("{}-{}", question.name, outcome.runs);
        let mut attempt = Attempt { question, program, out: &out, random: &mut random, outcome: &mut outcome };
        let (killed, ended) = attempt.run(signals, undisturbed.life);
        if killed > 0 {
            outcome.runs += 1;
            match ended.and_then(|printed| undisturbed.compare(question, &out, &printed)) {
                Ok(()) => outcome.same += 1,
                Err(fault) => outcome.faults.push(format!("{out}, seed {seed}, killed {killed} times: {fault}")),
            }
        }
        fs::remove_dir_all(question.path(&out)).unwrap();
    }
    outcome
}

/// The oracle.
pub struct Undisturbed {
    files: BTreeMap<PathBuf, Vec<u8>>,
    printed: String,
    /// How long it took, for the choice of moments alone.
    pub life: Duration,
}

impl Undisturbed {
    /// Runs a question on one thread.
    pub fn new(question: &Question, program: &Path) -> Self {
        let mut life = Duration::MAX;
        let mut printed = String::new();
        // The shortest of a few: other work of the machine makes a life seem longer than it is.
        for _ in 0..3 {
            fs::remove_dir_all(question.path("whole")).ok();
            let start = Instant::now();
            let output = question.command(program, "whole", &["--jobs", "1", "--threads", "1"]).output().unwrap();
            life = life.min(start.elapsed());
            assert!(output.status.success(), "{}: {}", question.name, String::from_utf8_lossy(&output.stderr));
            printed = String::from_utf8(output.stdout).unwrap();
        }
        Self { files: contents(&question.path("whole")), printed, life }
    }

    /// Whether another run left the same files and printed the same.
    pub fn compare(&self, question: &Question, out: &str, printed: &str) -> Result<(), String> {
        let files = contents(&question.path(out));
        match difference(&self.files, &files) {
            Some(difference) => Err(difference),
            None if self.printed != printed.replace(out, "whole") => Err(format!("it printed\n{printed}")),
            None => Ok(()),
        }
    }
}

struct Attempt<'a> {
    question: &'a Question,
    program: &'a Path,
    out: &'a str,
    random: &'a mut ChaCha8Rng,
    outcome: &'a mut Outcome,
}

impl Attempt<'_> {
    /// Kills a run once or more, and lets it end; how often it was killed, and what it printed at the end.
    fn run(&mut self, signals: Signals, life: Duration) -> (usize, Result<String, String>) {
        let planned = self.random.random_range(1..=MOST);
        let mut killed = 0;
        for _ in 0..planned {
            let mut child = self.command().stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            sleep(life.mul_f64(self.random.random_range(0.0..1.1)));
            let kill = match signals {
                Signals::Kill => true,
                Signals::Term => false,
                Signals::Mixed => self.random.random(),
            };
            let moment = self.moment();
            let hit = if kill { end_at_once(&mut child) } else { ask_to_end(&mut child) };
            match hit {
                Err(fault) => return (killed + 1, Err(fault)),
                Ok(false) => {}
                Ok(true) => {
                    killed += 1;
                    self.outcome.kills += 1;
                    self.outcome.moments[moment] += 1;
                }
            }
        }
        let output = self.command().output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        let ended = match output.status.success() {
            true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
            false => Err(format!("resumed, it ended with {:?}: {told}", output.status.code())),
        };
        (killed, ended)
    }

    /// The question with `--resume` and random numbers of jobs and threads.
    fn command(&mut self) -> Command {
        let [jobs, threads] = [0, 1].map(|_| self.random.random_range(1..=3).to_string());
        self.question.command(self.program, self.out, &["--resume", "--jobs", &jobs, "--threads", &threads])
    }

    /// 0 before the first checkpoint or record, 1 before the first record, 2 after it.
    fn moment(&self) -> usize {
        let there = |file: &Path, kind: &str| file.iter().any(|part| part == kind);
        let root = self.question.path(self.out);
        let names: Vec<PathBuf> = files(&root);
        match (names.iter().any(|f| there(f, "records")), names.iter().any(|f| there(f, "checkpoints"))) {
            (true, _) => 2,
            (false, true) => 1,
            (false, false) => 0,
        }
    }
}

/// Names alone: somebody is writing there.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return vec![] };
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// SIGKILL; whether it met the process alive.
fn end_at_once(child: &mut Child) -> Result<bool, String> {
    child.kill().unwrap();
    match child.wait().unwrap().code() {
        None => Ok(true),
        Some(0) => Ok(false),
        Some(code) => Err(format!("it ended by itself with {code}")),
    }
}

/// SIGTERM; whether it stopped for it.
fn ask_to_end(child: &mut Child) -> Result<bool, String> {
    // A process that is not there any more is no failure: it was too late.
    drop(Command::new("kill").args(["-TERM", &child.id().to_string()]).stderr(Stdio::null()).status());
    match child.wait().unwrap().code() {
        // Before it listens, the signal ends it.
        Some(130) | None => Ok(true),
        Some(0) => Ok(false),
        Some(code) => Err(format!("asked to stop, it ended with {code}")),
    }
}
