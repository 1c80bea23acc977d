//! A model that is a program: a line in for each sample, a line out for each.
//!
//! ```text
//! in    time,q1,q2,payload        header, then a line a sample
//!       0,0.1,-0.2,45
//! out   12.5,0.3,-80.1            one number an output, between commas or blanks
//! ```
//!
//! It is started anew for each trial, so it may remember what it was given.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread;

use nalgebra::DMatrix;

use super::given::Given;
use crate::error::DataError;

/// Bytes of an answer at most.
const LONGEST: u64 = 1 << 16;

/// A program with its arguments.
#[derive(Debug, Clone)]
pub struct Program {
    /// As the command line has them; the program first.
    words: Vec<OsString>,
}

impl Program {
    /// Of a command line.
    ///
    /// # Errors
    /// There is no word.
    pub fn new(words: Vec<OsString>) -> Result<Self, DataError> {
        match words.is_empty() {
            true => Err(DataError::Usage("no program is named; write it behind --".into())),
            false => Ok(Self { words }),
        }
    }

    /// As it was written.
    pub fn name(&self) -> String {
        self.words.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
    }

    /// Answers to all samples of a trial [T×M].
    ///
    /// # Errors
    /// A program that cannot be started, ends before its last answer, or answers anything else than M numbers a line.
    pub fn answers(&self, given: &Given) -> Result<DMatrix<f64>, DataError> {
        let mut child = self.start()?;
        let lines = child.stdin.take().map(|to| {
            let given = given.clone();
            // The program may answer only after its last line, so what it is told goes its own way.
            thread::spawn(move || send(&given, to))
        });
        let read = self.read(&mut child, given);
        if read.is_err() {
            // It may wait for a reader that has gone.
            let _ = child.kill();
        }
        let ended = child.wait().map_err(|error| self.refused(given, format!("was lost: {error}"), END))?;
        lines.map(thread::JoinHandle::join);
        let answers = read?;
        if answers.len() < given.samples() {
            let what = format!("answered {} of {} lines and ended ({ended})", answers.len(), given.samples());
            return Err(self.refused(given, what, END));
        }
        if !ended.success() {
            return Err(self.refused(given, format!("ended with {ended}"), "see what it said on standard error"));
        }
        Ok(DMatrix::from_fn(answers.len(), given.outputs, |t, o| answers[t][o]))
    }

    fn start(&self) -> Result<Child, DataError> {
        let mut command = Command::new(&self.words[0]);
        command.args(&self.words[1..]).stdin(Stdio::piped()).stdout(Stdio::piped());
        command.spawn().map_err(|error| {
            let program = self.words[0].to_string_lossy();
            DataError::Usage(format!("{program} cannot be started: {error}; name a program, as seen from here"))
        })
    }

    /// An answer for each sample, or fewer where the program ends before.
    fn read(&self, child: &mut Child, given: &Given) -> Result<Vec<Vec<f64>>, DataError> {
        let Some(out) = child.stdout.take() else { return Ok(vec![]) };
        let (mut out, mut line, mut answers) = (BufReader::new(out), vec![], vec![]);
        loop {
            line.clear();
            let count = (&mut out).take(LONGEST).read_until(b'\n', &mut line);
            let count = count.map_err(|error| self.refused(given, format!("cannot be read: {error}"), END))?;
            if count == 0 {
                return Ok(answers);
            }
            let text = String::from_utf8_lossy(&line);
            if text.trim().is_empty() {
                continue;
            }
            if answers.len() == given.samples() {
                let what = format!("answered more than the {} lines that it was given", given.samples());
                return Err(self.refused(given, what, "print one line for each, and no header"));
            }
            answers.push(numbers(&text, given.outputs).ok_or_else(|| {
                let said: String = text.trim().chars().take(60).collect();
                let what =
                    format!("answered {said:?} to line {}, and not {} numbers", answers.len() + 1, given.outputs);
                self.refused(given, what, "print a number an output, with commas between them, and nothing else")
            })?);
        }
    }

    fn refused(&self, given: &Given, what: String, remedy: &'static str) -> DataError {
        DataError::Model { trial: given.trial.clone(), what: format!("`{}` {what}", self.name()), remedy }
    }
}

const END: &str = "print one line for each line that comes in, up to the end of the input";

/// A header and all samples; a program that does not listen any more is no error here.
fn send(given: &Given, to: ChildStdin) {
    let mut to = BufWriter::new(to);
    let names: Vec<&str> = given.columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut sent = writeln!(to, "{}", names.join(","));
    for t in 0..given.samples() {
        let cells: Vec<String> = given.columns.iter().map(|(_, values)| values[t].to_string()).collect();
        sent = sent.and_then(|()| writeln!(to, "{}", cells.join(",")));
    }
    drop(sent.and_then(|()| to.flush()));
}

fn numbers(line: &str, count: usize) -> Option<Vec<f64>> {
    let words = line.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
    numbers.filter(|numbers| numbers.len() == count)
}
