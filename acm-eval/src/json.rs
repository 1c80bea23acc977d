//! JSON files that name the version of their format.

use std::path::Path;

use acm_train::record::FORMAT;
use serde::{Deserialize, de::DeserializeOwned};

use crate::error::EvalError;

/// A JSON file with a `format`. The version is read first: a record of another version may lack what this one has.
///
/// # Errors
/// Unreadable, of another version, or damaged: with file, line and column.
pub fn versioned<T: DeserializeOwned>(file: &Path) -> Result<T, EvalError> {
    #[derive(Deserialize)]
    struct Version {
        format: u64,
    }
    let text = std::fs::read_to_string(file).map_err(|source| EvalError::read(file, source))?;
    match json::<Version>(&text, file)?.format {
        found if found == u64::from(FORMAT) => json(&text, file),
        found => {
            let remedy = match found > u64::from(FORMAT) {
                true => "use a newer acm-eval",
                false => "train again with this version's acm-train",
            };
            Err(EvalError::Format { file: file.into(), found, known: FORMAT, remedy })
        }
    }
}

fn json<T: DeserializeOwned>(text: &str, file: &Path) -> Result<T, EvalError> {
    serde_json::from_str(text).map_err(|error| EvalError::Json {
        file: file.into(),
        line: error.line(),
        column: error.column(),
        reason: without_place(&error.to_string()),
    })
}

/// serde_json ends its message with the place, which stands before the message here.
fn without_place(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_string()
}
