//! The files of `slurm/` in a folder of runs.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use acm_datasets::files::atomic::sweep;
use acm_datasets::files::lock::{self, Lock, Refused};
use sha2::{Digest, Sha256};

use super::array::list::List;
use crate::{
    schedule::error::ScheduleError,
    store::{StoreError, atomic, in_use},
};

/// Folder `slurm/` of a run or study.
#[derive(Debug, Clone)]
pub struct SlurmFolder {
    /// The folder of the whole, absolute.
    pub root: PathBuf,
}

impl SlurmFolder {
    /// Returns the folder `slurm/` of the folder `root`.
    ///
    /// # Errors
    /// There is no current directory, or the path cannot stand in a script.
    pub fn new(root: &Path) -> Result<Self, ScheduleError> {
        let root = std::path::absolute(root).map_err(|source| StoreError::io("find", root, source))?;
        // The same folder has the same name for Slurm, by whatever path it is called.
        Ok(Self { root: root.canonicalize().unwrap_or(root) })
    }

    /// Returns the folder whose list `file` is.
    pub fn of_list(file: &Path) -> Option<Self> {
        Some(Self { root: file.parent()?.parent()?.to_path_buf() })
    }

    /// Returns a file of `slurm/`.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join("slurm").join(name)
    }

    /// Returns the path of the list, script or job of the array with a number.
    pub fn of(&self, number: usize, extension: &str) -> PathBuf {
        self.path(&format!("{number:04}.{extension}"))
    }

    /// Returns the path of the log of a task.
    pub fn log(&self, number: usize, index: usize) -> PathBuf {
        self.path(&format!("logs/{number:04}_{index}.log"))
    }

    /// Returns the path of the attempts at a run, or of its lock.
    pub fn tries(&self, id: &str, extension: &str) -> PathBuf {
        self.path(&format!("tries/{id}.{extension}"))
    }

    /// Returns the job name of the array with a number, unique to this folder, so that it can be found again.
    pub fn job_name(&self, number: usize) -> String {
        format!("acm-{number:04}-{}", self.key())
    }

    /// Returns the job name of the collector.
    pub fn collector_name(&self) -> String {
        format!("acm-collect-{}", self.key())
    }

    fn key(&self) -> String {
        let hash = Sha256::digest(self.root.to_string_lossy().as_bytes());
        acm_hashed::hexadecimal(&hash[..5])
    }

    /// Reads all lists so far, with their numbers, the first first.
    ///
    /// # Errors
    /// A list cannot be read.
    pub fn lists(&self) -> Result<Vec<(usize, List)>, ScheduleError> {
        let mut numbers = self.numbers()?;
        numbers.sort_unstable();
        numbers.into_iter().map(|number| Ok((number, List::read(&self.of(number, "json"))?))).collect()
    }

    fn numbers(&self) -> Result<Vec<usize>, ScheduleError> {
        let folder = self.path("");
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(vec![]),
            Err(source) => return Err(StoreError::io("read", folder, source).into()),
        };
        let mut numbers = vec![];
        for entry in entries {
            let name = entry.map_err(|source| StoreError::io("read", &folder, source))?.file_name();
            numbers.extend(name.to_string_lossy().strip_suffix(".json").and_then(|stem| stem.parse::<usize>().ok()));
        }
        Ok(numbers)
    }

    /// Locks the submission, so that one process at a time submits. Dropping the lock releases it.
    ///
    /// # Errors
    /// Another one has been at it for ten seconds, or the file system refuses.
    pub fn plan(&self) -> Result<Lock, ScheduleError> {
        let path = self.path(".lock");
        atomic::make_folder(&self.path("logs"))?;
        let lock = lock::wait(&path).map_err(|refused| in_use(&self.root, &path, refused))?;
        sweep(&self.path(""))?;
        Ok(lock)
    }

    /// Returns the lock of one run; `None` where a process works on it.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn run(&self, id: &str) -> Result<Option<Lock>, ScheduleError> {
        let path = self.tries(id, "lock");
        atomic::make_folder(path.parent().unwrap_or(&self.root))?;
        match lock::take(&path) {
            Ok(lock) => Ok(Some(lock)),
            Err(Refused::Held(_)) => Ok(None),
            Err(Refused::Io(source)) => Err(StoreError::io("lock", path, source).into()),
        }
    }

    /// Returns whether a process works on a run.
    pub fn at_work(&self, id: &str) -> bool {
        let path = self.tries(id, "lock");
        path.exists() && lock::is_held(&path)
    }
}
