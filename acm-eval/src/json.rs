//! Records: JSON files that carry their own hash and name the version of their format.

use std::path::Path;

use acm_train::{
    run::record::FORMAT,
    store::hashed::{self, Broken},
};
use serde::{Deserialize, de::DeserializeOwned};

use crate::error::EvalError;

/// Reads a record whose hash fits. The version is read first: a record of another version may lack fields of this one.
///
/// # Errors
/// Unreadable, of another version, or changed since it was written: with the file, and line and column where they are known.
pub fn versioned<T: DeserializeOwned>(file: &Path) -> Result<T, EvalError> {
    #[derive(Deserialize)]
    struct Version {
        format: u64,
    }
    let bytes = hashed::bytes(file)?;
    let verified = hashed::verify(&bytes);
    // A changed file is not believed in anything; where its text breaks off is where to look, and a former version, which
    // wrote no hash, says itself that it is one.
    let text = match &verified {
        Ok(text) => text.clone(),
        Err(_) => String::from_utf8_lossy(&bytes).into_owned(),
    };
    let version = json::<Version>(&text, file)?.format;
    if let Err(broken) = verified
        && (broken == Broken::Differs || version == u64::from(FORMAT))
    {
        return Err(EvalError::Record { file: file.into(), reason: broken.to_string() });
    }
    match version {
        found if found == u64::from(FORMAT) => json(&text, file),
        found => {
            let remedy = match found > u64::from(FORMAT) {
                true => "use a newer acm-eval",
                false => "train again with this version's acm-train, with `--out DIR`",
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

/// Removes the place from the end of serde_json's message, since the message here begins with it.
fn without_place(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_string()
}
