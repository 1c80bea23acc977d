//! A run folder: one experiment, one data set, one process at a time.
//!
//! A folder is claimed by a lock that the operating system releases when the process ends, however it ends. It then
//! belongs to the experiment and the data hash written in it: `--resume` continues that experiment and no other.

mod shared;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use acm_datasets::{
    atomic::sweep,
    lock::{self, Lock, Refused},
};
use serde::Serialize;
use toml::{Table, Value};

use crate::{
    atomic,
    error::TrainError,
    experiment::Experiment,
    hashed,
    record::{NominalRecord, RunRecord, read_nominal, read_record},
    sequences,
};

const LOCK: &str = ".lock";

/// Who else may be in a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Nobody.
    Alone {
        /// Whether to go on with what it holds.
        resume: bool,
    },
    /// Others that share it: each works on runs of its own.
    Shared,
    /// Anybody, since nothing is written.
    Look,
}

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
    pub fn claim(root: &Path, resume: bool) -> Result<Self, TrainError> {
        Self::hold(root, Hold::Alone { resume })
    }

    /// The same, alone or with others.
    ///
    /// # Errors
    /// As [`RunFolder::claim`].
    pub fn hold(root: &Path, hold: Hold) -> Result<Self, TrainError> {
        let lock = held(root, &["records", "predictions", "checkpoints"], "experiment.toml", hold)?;
        Ok(Self { root: root.into(), lock })
    }

    /// Writes what is to be run, or checks that it is what this folder was begun for.
    ///
    /// # Errors
    /// The folder belongs to another experiment or other data, or cannot be written.
    pub fn adopt(&self, experiment: &Experiment, nominal: &NominalRecord) -> Result<(), TrainError> {
        let before = match self.path("nominal.json").exists() {
            true => Some(read_nominal(&self.root)?.data.hash),
            false => None,
        };
        let write = || hashed::write(&self.path("nominal.json"), nominal);
        self.adopt_as(experiment, before, &nominal.data.hash, write)
    }

    /// The same for a question about sequences, of which `study.json` notes the data.
    ///
    /// # Errors
    /// As [`RunFolder::adopt`].
    pub fn adopt_question(
        &self,
        question: &impl Serialize,
        study: &sequences::record::StudyRecord,
    ) -> Result<(), TrainError> {
        let path = self.path("study.json");
        let before = match path.exists() {
            true => Some(sequences::record::read_study(&path)?.data.hash),
            false => None,
        };
        self.adopt_as(question, before, &study.data.hash, || hashed::write(&path, study))
    }

    fn adopt_as(
        &self,
        asked: &impl Serialize,
        before: Option<String>,
        now: &str,
        write: impl Fn() -> Result<(), TrainError>,
    ) -> Result<(), TrainError> {
        let path = self.path("experiment.toml");
        let text =
            toml::to_string(asked).map_err(|error| TrainError::io("write", &path, std::io::Error::other(error)))?;
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

    fn compare(&self, path: &Path, asked: &str) -> Result<(), TrainError> {
        let held = fs::read_to_string(path).map_err(|source| TrainError::io("read", path, source))?;
        let tables: Option<(Table, Table)> = held.parse().ok().zip(asked.parse().ok());
        match tables.map(|(held, asked)| differences(&leaves(&held), &leaves(&asked))) {
            Some(list) if list.is_empty() => Ok(()),
            Some(list) => Err(self.belongs(format!("another experiment: {}", list.join("; ")))),
            None => Err(self.belongs("an experiment.toml that is not TOML".into())),
        }
    }

    fn belongs(&self, what: String) -> TrainError {
        TrainError::Usage {
            what: format!("{} holds {what}", self.root.display()),
            help: "give this run a folder of its own with --out DIR, or put the former values back to resume".into(),
        }
    }

    /// The folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// A file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// Where the record of a run is written.
    pub fn record(&self, id: &str) -> PathBuf {
        self.path(&format!("records/{id}.json"))
    }

    /// Where the predictions of a run are written.
    pub fn predictions(&self, id: &str) -> PathBuf {
        self.path(&format!("predictions/{id}.parquet"))
    }

    /// Where the checkpoint of a run is written.
    pub fn checkpoint(&self, id: &str) -> PathBuf {
        self.path(&format!("checkpoints/{id}.safetensors"))
    }

    /// The record of a run that is finished.
    ///
    /// # Errors
    /// There is a file, and it is no record; or its table of predictions is missing or not the one it was written with.
    pub fn finished(&self, id: &str) -> Result<Option<RunRecord>, TrainError> {
        let path = self.record(id);
        if !path.exists() {
            return Ok(None);
        }
        let record = read_record(&path)?;
        hashed::same_file(&self.predictions(id), &record.predictions_sha256, &path)?;
        match self.other(&record)? {
            None => Ok(Some(record)),
            Some(why) => Err(TrainError::Changed { file: path, why: format!("it is of another experiment: {why}") }),
        }
    }

    /// Where a record's experiment differs from that of the folder; somebody may have copied it here.
    fn other(&self, record: &RunRecord) -> Result<Option<String>, TrainError> {
        let path = self.path("experiment.toml");
        let held = match path.exists() {
            true => fs::read_to_string(&path).map_err(|source| TrainError::io("read", path, source))?,
            false => return Ok(None),
        };
        let tables: Option<(Table, Table)> = held.parse().ok().zip(Table::try_from(&record.experiment).ok());
        let list = tables.map(|(held, found)| differences(&leaves(&held), &leaves(&found))).unwrap_or_default();
        Ok((!list.is_empty()).then(|| list.join("; ")))
    }
}

/// The claimed folder of a study, which holds a run folder for each experiment. Dropping it releases the lock.
#[derive(Debug)]
pub struct StudyFolder {
    root: PathBuf,
    _lock: Option<Lock>,
}

impl StudyFolder {
    /// Makes the folder if need be, and claims it for this process.
    ///
    /// # Errors
    /// As [`RunFolder::claim`].
    pub fn hold(root: &Path, hold: Hold) -> Result<Self, TrainError> {
        let lock = held(root, &["runs"], "study.json", hold)?;
        Ok(Self { root: root.into(), _lock: lock })
    }

    /// A file of the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }
}

/// Holds a folder as asked; no lock where nothing is to be written.
fn held(root: &Path, inside: &[&str], mark: &str, hold: Hold) -> Result<Option<Lock>, TrainError> {
    match hold {
        Hold::Alone { resume } => claim(root, inside, mark, resume).map(Some),
        Hold::Shared => shared::join(root, inside, mark).map(Some),
        Hold::Look => Ok(None),
    }
}

/// Makes a folder, locks it, and makes the folders `inside`; `mark` is the file that says it was used before.
pub(crate) fn claim(root: &Path, inside: &[&str], mark: &str, resume: bool) -> Result<Lock, TrainError> {
    refuse_strangers(root, mark)?;
    atomic::make_folder(root)?;
    let path = root.join(LOCK);
    let lock = lock::take(&path).map_err(|refused| in_use(root, &path, refused))?;
    for folder in inside {
        atomic::make_folder(&root.join(folder))?;
    }
    for folder in std::iter::once(&"").chain(inside) {
        sweep(&root.join(folder))?;
    }
    if !resume && root.join(mark).exists() {
        return Err(TrainError::Usage {
            what: format!("{} already holds a run", root.display()),
            help: "add --resume to continue it, or give this run a folder of its own with --out DIR".into(),
        });
    }
    Ok(lock)
}

/// Why the lock at `path` is not had.
pub(crate) fn in_use(folder: &Path, path: &Path, refused: Refused) -> TrainError {
    match refused {
        Refused::Held(holder) => TrainError::InUse { folder: folder.into(), holder },
        Refused::Io(source) => TrainError::io("lock", path, source),
    }
}

/// A folder that has files but neither a lock nor its mark was not made by this program.
fn refuse_strangers(root: &Path, mark: &str) -> Result<(), TrainError> {
    if !root.is_dir() || root.join(LOCK).exists() || root.join(mark).exists() {
        return Ok(());
    }
    let mut entries = fs::read_dir(root).map_err(|source| TrainError::io("read", root, source))?;
    // Somebody else may have begun here since.
    let stranger = |entry: fs::DirEntry| entry.file_name() != LOCK && !root.join(LOCK).exists();
    match entries.any(|entry| entry.is_ok_and(stranger)) {
        false => Ok(()),
        true => Err(TrainError::Usage {
            what: format!("{} is not empty, and is not a run folder", root.display()),
            help: "give this run a folder of its own with --out DIR".into(),
        }),
    }
}

/// Dotted key → value as TOML writes it.
fn leaves(table: &Table) -> BTreeMap<String, String> {
    let below = |(name, value): (&String, &Value)| -> Vec<(String, String)> {
        match value {
            Value::Table(inner) => leaves(inner).into_iter().map(|(key, v)| (format!("{name}.{key}"), v)).collect(),
            leaf => vec![(name.clone(), leaf.to_string())],
        }
    };
    table.iter().flat_map(below).collect()
}

fn differences(held: &BTreeMap<String, String>, asked: &BTreeMap<String, String>) -> Vec<String> {
    let keys: BTreeSet<&String> = held.keys().chain(asked.keys()).collect();
    let shown = |value: Option<&String>| value.map_or("its default", |v| v.as_str()).to_string();
    keys.into_iter()
        .filter(|key| key.as_str() != "question" && held.get(*key) != asked.get(*key))
        .map(|key| format!("{key} is {} there and {} here", shown(held.get(key)), shown(asked.get(key))))
        .collect()
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn differing_keys_are_named() {
        let table = |text: &str| leaves(&text.parse::<Table>().unwrap());
        let list = differences(&table("[network]\nunits = 32"), &table("[network]\nunits = 64"));
        assert_eq!(list, ["network.units is 32 there and 64 here"]);
    }
}
