//! Folder of a loop's result: one loop at a time, replaced atomically.
//!
//! ```text
//! OUT/model.json   the nominal model with what it lacked; acm-train takes it as [nominal] augmented
//! OUT/refuted.json the same model, in place of model.json, where held-out trials refute it
//! OUT/loop.html    everything on one page
//! OUT/figures/     each figure of the page as SVG and PNG
//! OUT/tables/      each table of the page as CSV, with every digit
//! OUT/loop.json    everything, for other programs
//! OUT/networks/    runs of acm-train, where networks were asked for
//! ```
//!
//! A folder is claimed by a lock that the operating system releases when the process ends, however it ends. All files are
//! written beside their places first, and take their names once the last one is on the disk. An earlier finding, its page,
//! figures and tables make room before the first of them does: whenever the process ends, all that is there is of one loop.
//! Files in `figures` and `tables` that no loop writes are the user's, and stay.

use std::{
    fs::{self, File},
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
};

use acm_datasets::files::atomic::{DRAFT_PREFIX, flush, make_folder, sweep};
use acm_datasets::files::lock::{self, Lock, Refused};
use acm_datasets::files::regular;
use acm_trace::{close::Closed, finding::Confirmation};
use acm_train::store::hashed;

use crate::closed_loop::page::beside::{self, Beside, FIGURES, TABLES};
use crate::error::EvalError;
use crate::{closed_loop, ownership};

const LOCK: &str = ".lock";
/// Name of the result for programs.
pub const FINDING: &str = "loop.json";
/// Name of the model.
pub const MODEL: &str = "model.json";
/// Name of a model that held-out trials refute.
pub const REFUTED: &str = "refuted.json";
const PAGE: &str = "loop.html";
const NETWORKS: &str = "networks";

/// A claimed folder. Dropping it releases the lock.
#[derive(Debug)]
pub struct LoopFolder {
    root: PathBuf,
    _lock: Lock,
}

impl LoopFolder {
    /// Makes the folder if need be, and claims it for this process.
    ///
    /// # Errors
    /// The folder is in use, holds something else, or cannot be made or written.
    pub fn claim(root: &Path) -> Result<Self, EvalError> {
        ensure_owned(root)?;
        make_folder(root).map_err(|source| EvalError::write(root, source))?;
        let path = root.join(LOCK);
        let lock = lock::take(&path).map_err(|refused| match refused {
            Refused::Held(holder) => EvalError::InUse { folder: root.into(), holder },
            Refused::Io(source) => EvalError::write(&path, source),
        })?;
        for folder in folders(root).iter().filter(|folder| folder.is_dir()) {
            sweep(folder).map_err(EvalError::Table)?;
        }
        Ok(Self { root: root.into(), _lock: lock })
    }

    /// Writes the model, figures and tables, the page and the finding; returns where the page is.
    ///
    /// # Errors
    /// A file cannot be written, or a figure drawn; an earlier result then stays as it was. Where a name cannot be taken, a
    /// part of one result may be missing.
    pub fn write(&self, closed: &Closed) -> Result<PathBuf, EvalError> {
        let files = self.files(closed)?;
        for folder in folders(&self.root) {
            make_folder(&folder).map_err(|source| EvalError::write(&folder, source))?;
        }
        for (name, bytes) in &files {
            let path = draft(&self.root.join(name));
            let written = File::create(&path).and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()));
            written.map_err(|source| EvalError::write(&path, source))?;
        }
        self.make_room(closed.finding.confirmation)?;
        for (name, _) in &files {
            let path = self.root.join(name);
            fs::rename(draft(&path), &path).map_err(|source| EvalError::write(&path, source))?;
        }
        self.flush()?;
        Ok(self.root.join(PAGE))
    }

    /// Returns all files, in the order in which names are taken.
    fn files(&self, closed: &Closed) -> Result<Vec<Beside>, EvalError> {
        let page = closed_loop::page(&closed.finding);
        let name = model_name(closed.finding.confirmation);
        let model = hashed::encode(&closed.model);
        let model = model.map_err(|error| EvalError::write(&self.root.join(name), error.into()))?;
        let mut files = vec![(name.to_string(), model)];
        files.extend(beside::of_finding(&closed.finding)?);
        files.push((PAGE.into(), page.into_bytes()));
        files.push((FINDING.into(), self.json(FINDING, &closed.finding)?));
        Ok(files)
    }

    /// Removes an earlier result, but for a model of the same name, which the new one replaces in one step.
    fn make_room(&self, confirmation: Confirmation) -> Result<(), EvalError> {
        let mut former = vec![self.root.join(FINDING), self.root.join(PAGE)];
        for inside in [FIGURES, TABLES] {
            let folder = self.root.join(inside);
            for entry in fs::read_dir(&folder).map_err(|source| EvalError::read(&folder, source))? {
                let entry = entry.map_err(|source| EvalError::read(&folder, source))?;
                if beside::is_own(inside, &entry.file_name().to_string_lossy()) {
                    former.push(entry.path());
                }
            }
        }
        former.push(self.root.join(other_name(confirmation)));
        for path in former {
            match fs::remove_file(&path) {
                Err(source) if source.kind() != ErrorKind::NotFound => return Err(EvalError::write(&path, source)),
                _ => {}
            }
        }
        self.flush()
    }

    fn flush(&self) -> Result<(), EvalError> {
        folders(&self.root)
            .iter()
            .try_for_each(|folder| flush(folder).map_err(|source| EvalError::write(folder, source)))
    }

    /// Returns the path of a model with this confirmation by held-out trials.
    pub fn model(&self, confirmation: Confirmation) -> PathBuf {
        self.root.join(model_name(confirmation))
    }

    /// Returns the folder of the networks.
    pub fn networks(&self) -> PathBuf {
        self.root.join(NETWORKS)
    }

    fn json(&self, name: &str, value: &impl serde::Serialize) -> Result<Vec<u8>, EvalError> {
        let text = serde_json::to_string_pretty(value);
        let text = text.map_err(|error| EvalError::write(&self.root.join(name), error.into()))?;
        Ok(format!("{text}\n").into_bytes())
    }
}

/// Returns `model.json`, or `refuted.json`, so that no program reads a refuted model by mistake.
fn model_name(confirmation: Confirmation) -> &'static str {
    if confirmation == Confirmation::Refuted { REFUTED } else { MODEL }
}

/// Returns the name of the model file that a result with this confirmation does not have.
fn other_name(confirmation: Confirmation) -> &'static str {
    if confirmation == Confirmation::Refuted { MODEL } else { REFUTED }
}

/// Returns the folders of the files.
fn folders(root: &Path) -> [PathBuf; 3] {
    [root.to_path_buf(), root.join(FIGURES), root.join(TABLES)]
}

/// Returns the path that a file is written to before it takes its name.
fn draft(path: &Path) -> PathBuf {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    path.with_file_name(format!("{DRAFT_PREFIX}{name}"))
}

/// Refuses a folder that holds something that this program did not make.
fn ensure_owned(root: &Path) -> Result<(), EvalError> {
    if !root.is_dir() {
        return Ok(());
    }
    let refuse = |what: String| Err(EvalError::NotOwned { folder: root.into(), made: "a loop's result", what });
    if root.join(FINDING).exists() {
        return match is_finding(&root.join(FINDING))? {
            true => Ok(()),
            false => refuse(format!("its {FINDING} is none of this program")),
        };
    }
    let claimed = root.join(LOCK).exists();
    let own = |name: &str| claimed && [LOCK, NETWORKS, MODEL, REFUTED, PAGE, FIGURES, TABLES].contains(&name);
    match ownership::first_foreign(root, own).map_err(|source| EvalError::read(root, source))? {
        Some(name) => refuse(format!("it holds {name} and no {FINDING}")),
        None => Ok(()),
    }
}

fn is_finding(file: &Path) -> Result<bool, EvalError> {
    let text = regular::read_to_string(file).map_err(|source| EvalError::read(file, source))?;
    let value: Option<serde_json::Value> = serde_json::from_str(&text).ok();
    Ok(value.is_some_and(|value| value.get("verdict").is_some() && value.get("effects").is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_claimed_once() {
        let parent = tempfile::tempdir().unwrap();
        let root = parent.path().join("deep/loop");
        let first = LoopFolder::claim(&root).unwrap();
        let second = LoopFolder::claim(&root).unwrap_err();
        assert_eq!(second.exit_code(), 5);
        drop(first);
        LoopFolder::claim(&root).unwrap();
    }

    #[test]
    fn a_folder_of_something_else_is_left_alone() {
        for (name, text) in [("thesis.tex", ""), ("loop.json", "{\"laps\": 3}"), ("model.json", "{}")] {
            let root = tempfile::tempdir().unwrap();
            fs::write(root.path().join(name), text).unwrap();
            let refused = LoopFolder::claim(root.path()).unwrap_err();
            assert_eq!(refused.exit_code(), 2, "{refused}");
            assert!(refused.to_string().contains(name), "{refused}");
            assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
        }
    }
}
