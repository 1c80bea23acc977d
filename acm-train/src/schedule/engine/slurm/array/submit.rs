//! Submission of missing runs as an array: list, script, job.

use std::{collections::BTreeSet, fs, path::Path};

use super::list::{Entry, List};
use crate::schedule::engine::slurm::commands::{self, SlurmError};
use crate::schedule::engine::slurm::folder::SlurmFolder;
use crate::{
    run::record::FORMAT,
    schedule::{error::ScheduleError, open::Planned, request::Request},
    store::{StoreError, atomic},
};

/// Returns the list of some runs, each of which may be begun `attempts` times, with all that their tasks must know, and
/// paths that hold from anywhere.
///
/// # Errors
/// There is no current directory.
pub fn list(attempts: usize, planned: &Planned, request: &Request, runs: &[Entry]) -> Result<List, ScheduleError> {
    let absolute = |path: &Path| std::path::absolute(path).map_err(|source| StoreError::io("find", path, source));
    let wanted: BTreeSet<usize> = runs.iter().map(|run| run.asked).collect();
    let places: Vec<usize> = wanted.into_iter().collect();
    let asked = places.iter().map(|&asked| {
        let mut asked = planned.asked[asked].clone();
        asked.file = absolute(&asked.file)?;
        Ok(asked)
    });
    let place = |asked: usize| places.binary_search(&asked).unwrap_or(0);
    Ok(List {
        format: FORMAT,
        attempts,
        data: request.data.map(absolute).transpose()?,
        asked: asked.collect::<Result<_, ScheduleError>>()?,
        runs: runs.iter().map(|run| Entry { asked: place(run.asked), ..run.clone() }).collect(),
    })
}

/// Writes the list to the disk, and submits the script. The list is removed where Slurm refuses. Where Slurm does not
/// answer it stays, since the job may have been taken: the next call asks for its name.
///
/// # Errors
/// Slurm refuses or does not answer, or the file system refuses.
pub fn submit(folder: &SlurmFolder, number: usize, list: &List, script: &str) -> Result<String, ScheduleError> {
    let (json, sh) = (folder.of(number, "json"), folder.of(number, "sh"));
    list.write(&json)?;
    atomic::write(&sh, script.as_bytes())?;
    match commands::submit(&sh) {
        Ok(job) => {
            atomic::write(&folder.of(number, "job"), format!("{job}\n").as_bytes())?;
            Ok(job)
        }
        Err(refusal) => {
            if !matches!(refusal, SlurmError::Silent { .. }) {
                for file in [json, sh] {
                    fs::remove_file(&file).map_err(|source| StoreError::io("remove", file, source))?;
                }
            }
            Err(refusal.into())
        }
    }
}
