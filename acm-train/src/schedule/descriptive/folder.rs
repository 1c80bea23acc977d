//! The folder of a descriptive study: `study.json`, and the tables from which its numbers can be computed again.
//!
//! ```text
//! runs/<name>/
//!   study.json                 what was asked, of which data, by which code, and what came out
//!   predictions/<part>.parquet one row per sample (or bin)
//! ```
//!
//! It belongs to what `study.json` says: another question or other data are refused, and the same question asked again
//! with `--resume` writes the same bytes.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use acm_datasets::files::lock::Lock;
use acm_datasets::files::table::{Column, write_parquet};
use serde::Serialize;
use serde_json::Value;

use crate::{
    run::record::FORMAT,
    store::{StoreError, claim, hashed},
};

/// Name of the record.
const RECORD: &str = "study.json";
/// Keys that must not change between two runs in one folder.
const IDENTITY: [&str; 4] = ["/kind", "/asked", "/experiment", "/data/hash"];

/// A claimed folder. Dropping it releases the lock.
#[derive(Debug)]
pub struct DescriptiveFolder {
    root: PathBuf,
    _lock: Lock,
}

impl DescriptiveFolder {
    /// Makes the folder if need be, and claims it for this process.
    ///
    /// # Errors
    /// The folder is in use, cannot be written, holds something else, or holds a study and `resume` is not given.
    pub fn claim(root: &Path, resume: bool) -> Result<Self, StoreError> {
        if root.join("experiment.toml").exists() {
            return Err(StoreError::Folder {
                what: format!("{} holds the runs of an experiment", root.display()),
                help: "give this study a folder of its own with --out DIR".into(),
            });
        }
        let lock = claim(root, &["predictions"], RECORD, resume)?;
        Ok(Self { root: root.into(), _lock: lock })
    }

    /// Returns the folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Writes a table of predictions, and notes its hash in `tables`.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn table(
        &self,
        name: &str,
        columns: &[(String, Column)],
        tables: &mut BTreeMap<String, String>,
    ) -> Result<(), StoreError> {
        let path = self.root.join("predictions").join(format!("{name}.parquet"));
        write_parquet(&path, columns)?;
        tables.insert(name.into(), hashed::of_file(&path)?);
        Ok(())
    }

    /// Writes the record, last of all.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn record(&self, record: &impl Serialize) -> Result<(), StoreError> {
        hashed::write(&self.root.join(RECORD), record)
    }

    /// Refuses a folder whose record has another subject than `asked` (a record without results will do).
    ///
    /// # Errors
    /// What differs, by its key.
    pub fn refuse_other(&self, asked: &impl Serialize) -> Result<(), StoreError> {
        let path = self.root.join(RECORD);
        if !path.exists() {
            return Ok(());
        }
        let held: Value = hashed::read(&path, FORMAT)?;
        let asked = serde_json::to_value(asked).map_err(|source| StoreError::Record { file: path.clone(), source })?;
        // The base's own question is a sentence, not a setting.
        let of = |value: &Value, key: &str| {
            let mut part = value.pointer(key).cloned().unwrap_or(Value::Null);
            part.as_object_mut().map(|table| table.remove("question"));
            part
        };
        let other = IDENTITY.iter().find_map(|key| {
            let (held, asked) = (of(&held, key), of(&asked, key));
            (held != asked).then(|| difference(&key[1..].replace('/', "."), &held, &asked))
        });
        match other {
            None => Ok(()),
            Some(difference) => Err(StoreError::Folder {
                what: format!("{} holds another study: {difference}", self.root.display()),
                help: "give this one a folder of its own with --out DIR, or put the former values back to resume"
                    .into(),
            }),
        }
    }
}

/// Returns the first leaf in which two values differ: `asked.bins is 40 there and 30 here`.
fn difference(key: &str, held: &Value, asked: &Value) -> String {
    if let (Some(a), Some(b)) = (held.as_object(), asked.as_object()) {
        let mut names: Vec<&String> = a.keys().chain(b.keys()).collect();
        names.sort();
        let at = |table: &serde_json::Map<String, Value>, name: &str| table.get(name).cloned().unwrap_or(Value::Null);
        if let Some(name) = names.into_iter().find(|name| at(a, name) != at(b, name)) {
            return difference(&format!("{key}.{name}"), &at(a, name), &at(b, name));
        }
    }
    format!("{key} is {held} there and {asked} here")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::fs;

    fn study(bins: usize, hash: &str) -> Value {
        json!({
            "format": FORMAT, "kind": "nominal", "asked": {"bins": bins}, "data": {"hash": hash},
            "experiment": {"question": "Why?", "nominal": {"degree": 3}},
        })
    }

    #[test]
    fn a_folder_is_claimed_once_and_repeated_only_when_asked() {
        let parent = tempfile::tempdir().unwrap();
        let root = parent.path().join("run");
        let first = DescriptiveFolder::claim(&root, false).unwrap();
        assert_eq!(DescriptiveFolder::claim(&root, false).unwrap_err().exit_code(), 5);
        first.record(&study(40, "beef")).unwrap();
        drop(first);
        assert!(DescriptiveFolder::claim(&root, false).unwrap_err().to_string().contains("already holds"));
        DescriptiveFolder::claim(&root, true).unwrap();
    }

    #[test]
    fn another_question_and_other_data_are_refused() {
        let parent = tempfile::tempdir().unwrap();
        let folder = DescriptiveFolder::claim(&parent.path().join("run"), false).unwrap();
        folder.refuse_other(&study(40, "beef")).unwrap();
        folder.record(&study(40, "beef")).unwrap();
        folder.refuse_other(&study(40, "beef")).unwrap();
        let refused = |asked: &Value| folder.refuse_other(asked).unwrap_err().to_string();
        assert!(refused(&study(30, "beef")).contains("asked.bins is 40 there and 30 here"));
        assert!(refused(&study(40, "cafe")).contains("data.hash is \"beef\" there and \"cafe\" here"));
        let mut reworded = study(40, "beef");
        reworded["experiment"]["question"] = "How?".into();
        folder.refuse_other(&reworded).unwrap();
        reworded["experiment"]["nominal"]["degree"] = 2.into();
        assert!(refused(&reworded).contains("experiment.nominal.degree is 3 there and 2 here"));
    }

    #[test]
    fn folders_of_something_else_are_left_alone() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("experiment.toml"), "").unwrap();
        assert_eq!(DescriptiveFolder::claim(root.path(), true).unwrap_err().exit_code(), 2);
        fs::rename(root.path().join("experiment.toml"), root.path().join("thesis.tex")).unwrap();
        assert_eq!(DescriptiveFolder::claim(root.path(), true).unwrap_err().exit_code(), 2);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
    }
}
