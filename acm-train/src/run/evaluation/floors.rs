//! `floors.json` beside the data: error floors that no estimator can beat, known for simulated data.

use std::{io, path::Path};

use acm_datasets::files::regular;

use crate::run::error::RunError;
use crate::run::record::Floors;
use crate::store::StoreError;

/// Returns the floors of a data folder; most folders have none.
///
/// # Errors
/// The file is there and cannot be read, or is not about floors.
pub fn read(folder: &Path) -> Result<Option<Floors>, RunError> {
    let path = folder.join("floors.json");
    let text = match regular::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(StoreError::io("read", path, source).into()),
    };
    serde_json::from_str(&text).map(Some).map_err(|error| RunError::Unusable {
        what: format!("{}: {error}", path.display()),
        help: "oracle_mm and memoryless_mm are needed, in mm; mend the file or remove it".into(),
    })
}
