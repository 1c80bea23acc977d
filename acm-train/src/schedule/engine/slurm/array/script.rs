//! Batch scripts for sbatch.
//!
//! Options of the command line come first and this program's own last, so that one that is passed on cannot take the
//! array, its name or its log away.

use std::path::Path;

use crate::schedule::engine::slurm::asked::Slurm;
use crate::schedule::engine::slurm::folder::SlurmFolder;
use crate::{schedule::error::ScheduleError, store::StoreError};

/// Folder and program of the tasks.
#[derive(Debug, Clone)]
pub struct Place {
    /// Directory that paths of the command line are relative to.
    pub directory: String,
    /// Program that tasks call.
    pub program: String,
}

impl Place {
    /// Returns the place of this process.
    ///
    /// # Errors
    /// A path cannot stand in a script, or is not known.
    pub fn new(slurm: &Slurm) -> Result<Self, ScheduleError> {
        let unknown = |source| StoreError::io("find", "the current directory", source);
        let directory = std::env::current_dir().map_err(unknown)?;
        let own = |source| StoreError::io("find", "this program", source);
        let program = match &slurm.options.program {
            Some(program) => std::path::absolute(program).map_err(own)?,
            None => std::env::current_exe().map_err(own)?,
        };
        Ok(Self { directory: plain(&directory)?, program: plain(&program)? })
    }
}

/// Returns the script of an array of `count` runs after the jobs `after`; `limit` of them at a time.
///
/// # Errors
/// A path cannot stand in a script.
pub fn array(
    slurm: &Slurm,
    place: &Place,
    folder: &SlurmFolder,
    number: usize,
    count: usize,
    after: &[String],
) -> Result<String, ScheduleError> {
    let options = &slurm.options;
    let limit = options.array_limit.map_or(String::new(), |limit| format!("%{limit}"));
    // A task that Slurm requeues may be held without end. A failed one is submitted again, and counted.
    let mut lines = vec!["--no-requeue".to_string()];
    lines.extend(asked(slurm));
    lines.extend(options.cpus.map(|cpus| format!("--cpus-per-task={cpus}")));
    lines.push(format!("--job-name={}", folder.job_name(number)));
    lines.push(format!("--array=0-{}{limit}", count - 1));
    lines.extend(dependency(after));
    lines.push(log(&folder.path(&format!("logs/{number:04}_")), "%a.log")?);
    lines.push(format!("--chdir={}", directive(&place.directory)));
    let list = plain(&folder.of(number, "json"))?;
    let call =
        format!("exec {} --task {} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"", quoted(&place.program), quoted(&list));
    let runs = if count == 1 { "1 run".into() } else { format!("{count} runs") };
    Ok(script(&format!("{runs}; {number:04}.json says what each index stands for."), &lines, &call))
}

/// Returns the script of the collector: this call once more, after the jobs `after`.
///
/// # Errors
/// A path cannot stand in a script.
pub fn collector(
    slurm: &Slurm,
    place: &Place,
    folder: &SlurmFolder,
    after: &[String],
) -> Result<String, ScheduleError> {
    let mut lines = asked(slurm);
    lines.push(format!("--job-name={}", folder.collector_name()));
    lines.extend(dependency(after));
    lines.push(log(&folder.path("logs/collector"), ".log")?);
    lines.push(format!("--chdir={}", directive(&place.directory)));
    // A collector that submits another passes on its own hash of the configuration.
    let own = |word: &&String| *word != "--dry-run" && !word.starts_with("--unchanged=");
    let unchanged = format!("--unchanged={}", slurm.fingerprint);
    let repeated = slurm.arguments.iter().filter(own).chain([&unchanged]);
    let words: Vec<String> = std::iter::once(&place.program).chain(repeated).map(|word| quoted(word)).collect();
    Ok(script("Submits what is missing by then, or writes the tables.", &lines, &format!("exec {}", words.join(" "))))
}

fn asked(slurm: &Slurm) -> Vec<String> {
    let options = &slurm.options;
    let named = [
        ("partition", &options.partition),
        ("account", &options.account),
        ("time", &options.time),
        ("mem", &options.memory),
    ];
    let given = named.iter().filter_map(|(name, value)| value.as_ref().map(|value| format!("--{name}={value}")));
    given.chain(options.sbatch.iter().cloned()).collect()
}

fn dependency(after: &[String]) -> Option<String> {
    (!after.is_empty()).then(|| format!("--dependency=afterany:{}", after.join(":")))
}

fn script(what: &str, options: &[String], call: &str) -> String {
    let options: String = options.iter().map(|option| format!("#SBATCH {option}\n")).collect();
    format!("#!/bin/sh\n# Written by acm-train: {what}\n{options}#SBATCH --open-mode=append\n{call}\n")
}

/// Returns the path of a log. Slurm reads `%` in its name as the beginning of a placeholder.
fn log(stem: &Path, rest: &str) -> Result<String, ScheduleError> {
    Ok(format!("--output={}", directive(&(plain(stem)?.replace('%', "%%") + rest))))
}

/// Returns a value of `#SBATCH`, in quotes.
fn directive(value: &str) -> String {
    format!("\"{}\"", value.replace('"', "\\\""))
}

/// Returns a word of the shell.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Returns a path that a directive can hold.
fn plain(path: &Path) -> Result<String, ScheduleError> {
    match path.to_str() {
        Some(text) if !text.contains(|c: char| c.is_control() || c == '\\') => Ok(text.into()),
        _ => Err(ScheduleError::Usage {
            what: format!("{path:?} cannot stand in a script of Slurm"),
            help: "use a folder whose path is UTF-8, without backslashes and line breaks".into(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_paths_keep_their_letters() {
        assert_eq!(quoted("it's 50 %"), "'it'\\''s 50 %'");
        let line = log(Path::new("/a \"b\"/50 %/0001_"), "%a.log").unwrap();
        assert_eq!(line, "--output=\"/a \\\"b\\\"/50 %%/0001_%a.log\"");
        assert!(plain(Path::new("/a\nb")).is_err() && plain(Path::new("/a\\b")).is_err());
    }
}
