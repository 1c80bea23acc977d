//! `study.json`: configuration of a study, and folders of its runs.
//!
//! ```text
//! runs/<name>/
//!   study.json         StudyRecord
//!   runs/<id>/         a run folder of each experiment; with inputs.select, its choice of inputs in inputs/
//!   best-<base>.toml   of a sweep: the experiment with the smallest validation error, ready to be run
//! ```

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::{
    config::Kind,
    run::record::{FORMAT, RunRecord, read_records},
    store::{StoreError, hashed},
};

/// A list of experiments and what became of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyRecord {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// Kind of the study: sweep, ablation, comparison or inputs.
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// The experiments, in order.
    pub members: Vec<MemberRecord>,
}

/// One experiment of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MemberRecord {
    /// Name of its run folder.
    pub id: String,
    /// Name of the experiment that was edited.
    pub base: String,
    /// Name of the edits.
    pub variant: String,
    /// Values that they set: dotted key, and value in TOML.
    pub values: Vec<(String, String)>,
}

/// Returns the run folder of a member.
pub fn folder(study: &Path, id: &str) -> PathBuf {
    study.join("runs").join(id)
}

/// A member with its runs.
#[derive(Debug, Clone, Copy)]
pub struct Runs<'a> {
    /// Member of the study.
    pub member: &'a MemberRecord,
    /// Finished runs, cross-validation first.
    pub records: &'a [RunRecord],
}

/// Reads `study.json` and the records of all members.
///
/// # Errors
/// A file cannot be read, is not what it should be, or is of a later format; the message names it.
pub fn read(study: &Path) -> Result<(StudyRecord, Vec<Vec<RunRecord>>), StoreError> {
    let file = study.join("study.json");
    let record: StudyRecord = hashed::read(&file, FORMAT)?;
    let records = record.members.iter().map(|member| read_records(&folder(study, &member.id)));
    let records = records.collect::<Result<_, _>>()?;
    Ok((record, records))
}
