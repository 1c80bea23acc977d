//! `floors.json` beside the data: what no estimator can beat, where the data's maker knows it.

use std::{fs, io, path::Path};

use crate::{error::TrainError, record::Floors};

/// The floors of a data folder; most folders have none.
///
/// # Errors
/// The file is there and cannot be read, or is not about floors.
pub fn read(folder: &Path) -> Result<Option<Floors>, TrainError> {
    let path = folder.join("floors.json");
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(TrainError::io("read", path, source)),
    };
    serde_json::from_str(&text).map(Some).map_err(|error| TrainError::Unusable {
        what: format!("{}: {error}", path.display()),
        help: "oracle_mm and memoryless_mm are needed, in mm; mend the file or remove it".into(),
    })
}
