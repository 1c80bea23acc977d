//! Slurm's own programs: sbatch, squeue, scontrol.

use std::{
    env,
    ffi::OsStr,
    io,
    path::Path,
    process::{Command, Output, Stdio},
};

use miette::Diagnostic;
use thiserror::Error;

/// Messages of Slurm when it is down, starting, or cut off; any other message is a refusal.
const SILENT: [&str; 6] = [
    "Unable to contact slurm controller",
    "Socket timed out",
    "Connection refused",
    "Zero Bytes were transmitted",
    "Communication connection failure",
    "temporarily unable to accept job",
];

/// Reasons of squeue that do not pass by themselves.
const HOLDS: [&str; 4] = ["JobHeld", "held", "DependencyNeverSatisfied", "BadConstraints"];

/// Largest array where Slurm does not say: its own default.
pub const LARGEST_ARRAY: usize = 1001;

/// Errors of Slurm's programs.
#[derive(Debug, Error, Diagnostic)]
pub enum SlurmError {
    /// There is no such program.
    #[error("cannot start {program}: {source}")]
    #[diagnostic(help(
        "run this on a machine of the cluster that has Slurm's programs; or leave --engine slurm out to compute here"
    ))]
    Missing {
        /// Name of the program.
        program: &'static str,
        /// Error of the operating system.
        source: io::Error,
    },

    /// The controller cannot be reached.
    #[error("Slurm does not answer; {program} says: {said}")]
    #[diagnostic(help("nothing is lost: once Slurm answers, the same command submits what is missing"))]
    Silent {
        /// Program that was called.
        program: &'static str,
        /// Message of the program.
        said: String,
    },

    /// Slurm refuses a request.
    #[error("{program} refuses: {said}")]
    #[diagnostic(help(
        "change the options for Slurm (--dry-run shows the script), then the same command submits what is missing"
    ))]
    Refused {
        /// Program that was called.
        program: &'static str,
        /// Message of the program.
        said: String,
    },

    /// Runs that were begun as often as they may.
    #[error("{what}")]
    #[diagnostic(help(
        "read the log, mend the cause, then allow more: the same command with --attempts N; runs with a record are kept"
    ))]
    Spent {
        /// Runs, their numbers of attempts, and the places of their logs.
        what: String,
        /// Exit code of the first run's last attempt, where known.
        code: u8,
    },
}

impl SlurmError {
    /// Returns the exit code of the process.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Missing { .. } | Self::Refused { .. } => 2,
            Self::Silent { .. } => 4,
            Self::Spent { code, .. } => *code,
        }
    }
}

/// A task, or a job without tasks, that Slurm has not ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Queued {
    /// Name of the job.
    pub name: String,
    /// Number of the job.
    pub job: String,
    /// Index of the task in an array.
    pub index: Option<usize>,
    /// Reason why it does not run, where a user has to act before it will.
    pub held: Option<String>,
}

/// Submits a script, and returns the job's number.
///
/// # Errors
/// sbatch is missing or refuses.
pub fn submit(script: &Path) -> Result<String, SlurmError> {
    let said = said("sbatch", &["--parsable".as_ref(), script.as_os_str()])?;
    // On a federation the number is followed by the cluster's name.
    let job = said.trim().split(';').next().unwrap_or_default().to_string();
    match job.is_empty() || !job.chars().all(|c| c.is_ascii_digit()) {
        true => Err(SlurmError::Refused { program: "sbatch", said: format!("no number of a job but {said:?}") }),
        false => Ok(job),
    }
}

/// Returns all jobs of these names that Slurm has not ended.
///
/// # Errors
/// squeue is missing or does not answer.
pub fn queued(names: &[String]) -> Result<Vec<Queued>, SlurmError> {
    let names = format!("--name={}", names.join(","));
    let arguments = ["--noheader", "--array", "--format=%j|%F|%K|%r", &names];
    let said = said("squeue", &arguments.map(OsStr::new))?;
    Ok(said.lines().filter_map(line).collect())
}

fn line(line: &str) -> Option<Queued> {
    let mut fields = line.trim().split('|');
    let (name, job, index, reason) = (fields.next()?, fields.next()?, fields.next()?, fields.next()?);
    let held = HOLDS.iter().any(|words| reason.contains(words)).then(|| reason.to_string());
    Some(Queued { name: name.into(), job: job.into(), index: index.parse().ok(), held })
}

/// Returns the limit of Slurm's array indices, which are below it.
///
/// # Errors
/// scontrol is missing or does not answer.
pub fn largest_array() -> Result<usize, SlurmError> {
    let said = said("scontrol", &["show", "config"].map(OsStr::new))?;
    let value = said.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize")?.split('=').nth(1));
    Ok(value.and_then(|value| value.trim().parse().ok()).unwrap_or(LARGEST_ARRAY))
}

fn said(program: &'static str, arguments: &[&OsStr]) -> Result<String, SlurmError> {
    let output = output(program, arguments).map_err(|source| SlurmError::Missing { program, source })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr).trim().to_string();
    match SILENT.iter().any(|words| said.contains(words)) {
        true => Err(SlurmError::Silent { program, said }),
        false => Err(SlurmError::Refused { program, said }),
    }
}

/// Runs a program of Slurm. A collector is a job itself: its own limits, from Slurm's environment, must not be passed
/// on to the next job.
fn output(program: &str, arguments: &[&OsStr]) -> io::Result<Output> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null());
    let own = |name: &str| name.starts_with("SLURM_") && name != "SLURM_CONF" && !name.starts_with("SLURM_CONF_");
    env::vars_os().filter(|(name, _)| own(&name.to_string_lossy())).for_each(|(name, _)| {
        command.env_remove(name);
    });
    command.output()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_squeue_are_read() {
        let task = Queued { name: "acm-0001-ab".into(), job: "12".into(), index: Some(7), held: None };
        assert_eq!(line("acm-0001-ab|12|7|Resources"), Some(task));
        assert_eq!(line("acm-collect-ab|13|N/A|None").unwrap().index, None);
        assert_eq!(line("acm-0001-ab|12|7|JobHeldUser").unwrap().held.as_deref(), Some("JobHeldUser"));
        assert_eq!(line(""), None);
    }
}
