//! Check that a collector finds the files as they were when it was submitted. Between Friday and Monday somebody may
//! have edited them for another question, whose answer does not belong into this folder.

use std::path::{Path, PathBuf};

use acm_datasets::files::regular;
use sha2::{Digest, Sha256};
use toml::Value;

use crate::{config::Source, schedule::error::ScheduleError, store::StoreError};

/// Computes the SHA-256, hex, over the requesting file and the experiment files that it names.
///
/// # Errors
/// One of them cannot be read.
pub fn fingerprint(source: &Source) -> Result<String, ScheduleError> {
    let mut hash = Sha256::new();
    for file in std::iter::once(source.path().to_path_buf()).chain(bases(source)) {
        let bytes = regular::read(&file).map_err(|error| StoreError::io("read", &file, error))?;
        hash.update(Sha256::digest(&bytes));
    }
    Ok(acm_hashed::hexadecimal(&hash.finalize()))
}

fn bases(source: &Source) -> Vec<PathBuf> {
    let folder = source.path().parent().unwrap_or(Path::new(""));
    let bases = source.tree.get("base").and_then(Value::as_array).into_iter().flatten();
    bases
        .filter_map(|base| base.get("experiment")?.as_str())
        .map(|file| folder.join(file))
        .filter(|f| f.exists())
        .collect()
}

/// Refuses files that have changed since the submission.
///
/// # Errors
/// They have.
pub fn refuse_changes(expected: Option<&str>, found: &str, source: &Source) -> Result<(), ScheduleError> {
    match expected {
        Some(expected) if expected != found => Err(ScheduleError::Usage {
            what: format!(
                "{}, or an experiment file that it names, has changed since its runs were submitted",
                source.path().display()
            ),
            help: "put it back as it was and call acm-train again, or ask the new question in a folder of its own"
                .into(),
        }),
        _ => Ok(()),
    }
}
