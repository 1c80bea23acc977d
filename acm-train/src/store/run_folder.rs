//! A run folder: one experiment, one data set, one process at a time.
//!
//! A folder is claimed by a lock that the operating system releases when the process ends, however it ends. It then
//! belongs to the experiment and the data hash written in it: `--resume` continues that experiment and no other.

use std::path::{Path, PathBuf};

use acm_datasets::files::{lock::Lock, regular};
use serde::Serialize;
use toml::Table;

use super::{
    atomic,
    differences::differences,
    error::StoreError,
    hold::{Hold, held},
};

/// A claimed run folder. Dropping it releases the lock.
#[derive(Debug)]
pub struct RunFolder {
    root: PathBuf,
    lock: Option<Lock>,
}

impl RunFolder {
    /// Makes the folder if need be, and claims it for this process.
    ///
    /// # Errors
    /// The folder is in use, cannot be made or written, holds something else, or holds runs and `resume` is not given.
    pub fn claim(root: &Path, resume: bool) -> Result<Self, StoreError> {
        Self::hold(root, Hold::Alone { resume })
    }

    /// Claims the folder, alone or with others.
    ///
    /// # Errors
    /// As [`RunFolder::claim`].
    pub fn hold(root: &Path, hold: Hold) -> Result<Self, StoreError> {
        let lock = held(root, &["records", "predictions", "checkpoints"], "experiment.toml", hold)?;
        Ok(Self { root: root.into(), lock })
    }

    /// Writes what is `asked` as `experiment.toml` and lets `write` record the data, or checks that both are what this
    /// folder was begun for: `before` is the hash of the data that it holds, if it holds any.
    ///
    /// # Errors
    /// The folder belongs to another experiment or other data, or cannot be written.
    pub(crate) fn adopt(
        &self,
        asked: &impl Serialize,
        before: Option<String>,
        now: &str,
        write: impl Fn() -> Result<(), StoreError>,
    ) -> Result<(), StoreError> {
        let path = self.path("experiment.toml");
        let text =
            toml::to_string(asked).map_err(|error| StoreError::io("write", &path, std::io::Error::other(error)))?;
        if path.exists() {
            self.compare(&path, &text)?;
        }
        if let Some(before) = before.filter(|before| before != now) {
            return Err(self.belongs(format!("other data (hash {before}, now {now})")));
        }
        if self.lock.is_none() {
            return Ok(());
        }
        write()?;
        atomic::write(&path, text.as_bytes())
    }

    fn compare(&self, path: &Path, asked: &str) -> Result<(), StoreError> {
        let held = regular::read_to_string(path).map_err(|source| StoreError::io("read", path, source))?;
        let tables: Option<(Table, Table)> = held.parse().ok().zip(asked.parse().ok());
        match tables.map(|(held, asked)| differences(&held, &asked)) {
            Some(list) if list.is_empty() => Ok(()),
            Some(list) => Err(self.belongs(format!("another experiment: {}", list.join("; ")))),
            None => Err(self.belongs("an experiment.toml that is not TOML".into())),
        }
    }

    fn belongs(&self, what: String) -> StoreError {
        StoreError::Folder {
            what: format!("{} holds {what}", self.root.display()),
            help: "give this run a folder of its own with --out DIR, or put the former values back to resume".into(),
        }
    }

    /// Returns the folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Returns a file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// Returns the path of the record of a run.
    pub fn record(&self, id: &str) -> PathBuf {
        self.path(&format!("records/{id}.json"))
    }

    /// Returns the path of the predictions of a run.
    pub fn predictions(&self, id: &str) -> PathBuf {
        self.path(&format!("predictions/{id}.parquet"))
    }

    /// Returns the path of the checkpoint of a run.
    pub fn checkpoint(&self, id: &str) -> PathBuf {
        self.path(&format!("checkpoints/{id}.safetensors"))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_folder_is_claimed_once() {
        let parent = tempfile::tempdir().unwrap();
        let root = parent.path().join("run");
        let first = RunFolder::claim(&root, false).unwrap();
        let second = RunFolder::claim(&root, false).unwrap_err();
        assert_eq!(second.exit_code(), 5);
        assert!(second.to_string().contains("run"), "{second}");
        drop(first);
        RunFolder::claim(&root, false).unwrap();
    }

    #[test]
    fn a_folder_of_something_else_is_left_alone() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("thesis.tex"), "").unwrap();
        let refused = RunFolder::claim(root.path(), true).unwrap_err();
        assert_eq!(refused.exit_code(), 2);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
    }
}
