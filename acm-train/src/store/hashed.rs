//! Files of a run folder that carry their own SHA-256 ([`acm_hashed`]): records, `nominal.json`, `study.json`, saved models.
//!
//! A table of predictions is a file of its own, and the record that names it holds its hash ([`of_file`]).

use std::{
    io,
    path::{Path, PathBuf},
};

pub use acm_hashed::{Broken, begins, encode, verify};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use sha2::{Digest, Sha256};

use super::{atomic, bounded, error::StoreError};

/// Largest size of a record. Longer files are not read.
const MOST: u64 = 256 << 20;

/// Writes `value` to `path` with its hash, atomically.
///
/// # Errors
/// As [`atomic::write()`].
pub fn write(path: &Path, value: &impl Serialize) -> Result<(), StoreError> {
    let bytes = encode(value).map_err(|source| StoreError::io("write", path, io::Error::other(source)))?;
    atomic::write(path, &bytes)
}

/// Reads what [`write()`] wrote, where its key `format` is the one that is known here.
///
/// # Errors
/// The file cannot be read, has been changed, is of another format, or is something else; the message names it.
pub fn read<T: DeserializeOwned>(path: &Path, known: u32) -> Result<T, StoreError> {
    #[derive(Deserialize)]
    struct Version {
        format: u32,
    }
    let bytes = bytes(path)?;
    let other = |text: &str| serde_json::from_str(text).ok().map(|v: Version| v.format).filter(|&v| v != known);
    let refuse = |found| StoreError::RecordFormat { file: path.into(), found, known };
    let text = verify(&bytes).map_err(|broken| {
        // A former version wrote no hash; what it wrote says so itself.
        let unhashed = (broken == Broken::NoHash).then(|| str::from_utf8(&bytes).ok().and_then(other)).flatten();
        unhashed.map_or_else(|| StoreError::Changed { file: path.into(), why: broken.to_string() }, refuse)
    })?;
    if let Some(found) = other(&text) {
        return Err(refuse(found));
    }
    serde_json::from_str(&text).map_err(|source| StoreError::Record { file: path.into(), source })
}

/// Returns the bytes of a file of a run folder, up to a length that could be right.
///
/// # Errors
/// The file cannot be read, or is too long.
pub fn bytes(path: &Path) -> Result<Vec<u8>, StoreError> {
    bounded::read(path, MOST).map_err(|source| StoreError::io("read", path, source))
}

/// Returns the SHA-256 of a file's bytes, in hexadecimal; of any length, since it is read in pieces.
///
/// # Errors
/// The file cannot be read.
pub fn of_file(path: &Path) -> Result<String, StoreError> {
    let mut hash = Sha256::new();
    let read = bounded::open(path).and_then(|mut file| io::copy(&mut file, &mut Feed(&mut hash)));
    read.map_err(|source| StoreError::io("read", path, source))?;
    Ok(acm_hashed::hexadecimal(&hash.finalize()))
}

/// Checks that the file at `path` is still the one whose hash was `noted` by `record`.
///
/// # Errors
/// It is missing, cannot be read, or has been changed since.
pub fn same_file(path: &Path, noted: &str, record: &Path) -> Result<(), StoreError> {
    let refuse = |why: &str| Err(StoreError::Table { file: path.into(), record: record.into(), why: why.into() });
    match of_file(path) {
        Ok(found) if found == noted => Ok(()),
        Ok(_) => refuse("it is not the file whose SHA-256 the record holds"),
        Err(StoreError::Io { source, .. }) if source.kind() == io::ErrorKind::NotFound => refuse("it is missing"),
        Err(error) => Err(error),
    }
}

/// A hash is fed as a file is written.
struct Feed<'a>(&'a mut Sha256);

impl io::Write for Feed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Returns `records/a.json` below its run folder, for `predictions/a.parquet` there.
pub fn record_of(table: &Path) -> PathBuf {
    let name = table.file_stem().unwrap_or_default();
    let folder = table.parent().and_then(Path::parent).unwrap_or(Path::new(""));
    folder.join("records").join(name).with_extension("json")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn what_is_wrong_is_said_with_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.json");
        let refused = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            let error = read::<Value>(&path, 2).unwrap_err();
            assert!(error.to_string().contains("record.json"), "{error}");
            error
        };
        let sample = json!({"format": 2, "rmse": [0.1, 2.5e-300]});
        write(&path, &sample).unwrap();
        assert_eq!(read::<Value>(&path, 2).unwrap(), sample);
        let before = refused(b"{\"format\": 1, \"id\": \"of a former version\"}");
        assert!(matches!(before, StoreError::RecordFormat { found: 1, known: 2, .. }), "{before}");
        let later = refused(&encode(&json!({"format": 3})).unwrap());
        assert!(matches!(later, StoreError::RecordFormat { found: 3, known: 2, .. }), "{later}");
        let edited = refused(b"{\"format\": 2, \"id\": \"by hand\"}");
        assert!(matches!(edited, StoreError::Changed { .. }), "{edited}");
    }

    #[test]
    fn a_table_that_was_swapped_or_lost_is_named_with_its_record() {
        let folder = tempfile::tempdir().unwrap();
        let (table, record) = (folder.path().join("predictions/a.parquet"), folder.path().join("records/a.json"));
        assert_eq!(record_of(&table), record);
        std::fs::create_dir(folder.path().join("predictions")).unwrap();
        std::fs::write(&table, "abc").unwrap();
        // The example of FIPS 180-2.
        let noted = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        same_file(&table, noted, &record).unwrap();
        std::fs::write(&table, "abd").unwrap();
        let swapped = same_file(&table, noted, &record).unwrap_err().to_string();
        assert!(swapped.contains("a.parquet") && swapped.contains("a.json"), "{swapped}");
        std::fs::remove_file(&table).unwrap();
        assert!(same_file(&table, noted, &record).unwrap_err().to_string().contains("missing"));
    }
}
