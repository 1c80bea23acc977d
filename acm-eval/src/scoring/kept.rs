//! Rows on disk: one JSON value a line, written when done, so that an interrupted run can continue.
//!
//! ```text
//! {"format": 2, "version": …, "program": …, "configuration": …}   what made them
//! {"key": {"seed": …, "design": …, "kind": …}, "row": …}          one campaign or rig
//! ```
//!
//! A line that ends early, as a program that was stopped leaves it, counts as not written.

use std::fs::{File, OpenOptions};
use std::hash::{DefaultHasher, Hasher};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use acm_datasets::files::regular;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::answer::Answer;
use super::plan::Key;
use crate::error::EvalError;

/// Version of this layout.
const FORMAT: u32 = 2;

/// Program and configuration that made the rows of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of this layout.
    pub format: u32,
    /// Version of the program.
    pub version: String,
    /// Fingerprint of the program file: rows of another build are from another program.
    pub program: String,
    /// Configuration of the search, with its criteria.
    pub configuration: Value,
}

#[derive(Debug, Serialize, Deserialize)]
struct Line<R> {
    key: Key,
    row: R,
}

/// A file of rows that is being added to.
pub struct Kept<R> {
    file: Mutex<File>,
    path: PathBuf,
    known: Vec<(Key, R)>,
}

impl Header {
    /// Returns the header of this program.
    ///
    /// # Errors
    /// The program file cannot be read.
    pub fn new(configuration: Value) -> Result<Self, EvalError> {
        let program = fingerprint()?;
        Ok(Self { format: FORMAT, version: env!("CARGO_PKG_VERSION").into(), program, configuration })
    }
}

/// Computes the SipHash of the running program's file. It distinguishes builds, and is no protection.
fn fingerprint() -> Result<String, EvalError> {
    let path = std::env::current_exe().map_err(|error| EvalError::read(Path::new("acm-eval"), error))?;
    let failed = |error| EvalError::read(&path, error);
    let (mut file, mut hash) = (regular::open(&path).map_err(failed)?, DefaultHasher::new());
    let mut piece = vec![0; 1 << 20];
    loop {
        match file.read(&mut piece).map_err(failed)? {
            0 => return Ok(format!("{:016x}", hash.finish())),
            many => hash.write(&piece[..many]),
        }
    }
}

impl<R: Serialize + DeserializeOwned + Clone> Kept<R> {
    /// Opens a file for more rows, or begins it.
    ///
    /// # Errors
    /// The file system; rows that another configuration made.
    pub fn open(path: &Path, header: &Header) -> Result<Self, EvalError> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| EvalError::write(folder, e))?;
        }
        let text = text(path)?;
        let lines = lines(&text);
        if let Some(first) = lines.first() {
            let found = serde_json::from_str::<Header>(first).ok();
            if found.as_ref() != Some(header) {
                let what = "holds rows of another program or configuration";
                return Err(EvalError::Usage(format!(
                    "{}: {what}; name another folder with --out, or delete the file",
                    path.display()
                )));
            }
        }
        let rows = lines.iter().skip(1).filter_map(|line| serde_json::from_str::<Line<R>>(line).ok());
        let known = rows.map(|line| (line.key, line.row)).collect();
        let file = OpenOptions::new().create(true).append(true).open(path).map_err(|e| EvalError::write(path, e))?;
        let kept = Self { file: Mutex::new(file), path: path.into(), known };
        if lines.is_empty() {
            kept.write(header)?;
        } else if !text.ends_with('\n') {
            // What was cut off ends here.
            kept.write_text("\n")?;
        }
        Ok(kept)
    }

    /// Returns the row of a key, where it is there already.
    pub fn row(&self, key: &Key) -> Option<R> {
        self.known.iter().find(|(known, _)| known == key).map(|(_, row)| row.clone())
    }

    /// Adds a row.
    ///
    /// # Errors
    /// The file system.
    pub fn add(&self, key: Key, row: &R) -> Result<(), EvalError> {
        self.write(&Line { key, row })
    }

    fn write(&self, value: &impl Serialize) -> Result<(), EvalError> {
        let text = serde_json::to_string(value).map_err(|e| EvalError::write(&self.path, e.into()))?;
        self.write_text(&format!("{text}\n"))
    }

    fn write_text(&self, text: &str) -> Result<(), EvalError> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(text.as_bytes()).map_err(|e| EvalError::write(&self.path, e))
    }
}

/// Reads a file, which may end within a character; nothing where there is no file.
fn text(path: &Path) -> Result<String, EvalError> {
    match regular::read(path) {
        Ok(bytes) => Ok(String::from_utf8_lossy(&bytes).into_owned()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(EvalError::read(path, error)),
    }
}

/// Returns the lines that are not empty.
fn lines(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.trim().is_empty()).collect()
}

/// Reads the answers of all files of rows in a folder, in the order of their names.
///
/// # Errors
/// The file system; a folder without rows.
pub fn answers(folder: &Path) -> Result<Vec<Answer>, EvalError> {
    #[derive(Deserialize)]
    struct Answered {
        answer: Answer,
    }
    let entries = std::fs::read_dir(folder).map_err(|e| EvalError::read(folder, e))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|end| end == "jsonl"));
    files.sort();
    let mut all = Vec::new();
    for file in &files {
        let text = text(file)?;
        let rows = lines(&text).into_iter().filter_map(|line| serde_json::from_str::<Line<Answered>>(line).ok());
        all.extend(rows.map(|line| line.row.answer));
    }
    if all.is_empty() {
        let what = "holds no rows; make some with `acm-eval score-loop --out DIR`";
        return Err(EvalError::Usage(format!("{}: {what}", folder.display())));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::answer::{answer, claim};

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Row {
        answer: Answer,
    }

    fn key(seed: u64) -> Key {
        Key { seed, design: None, kind: "axis".into(), without_own: false }
    }

    /// Oracle: what was written, after the last line was cut within a character; a file that is whole is not added to.
    #[test]
    fn a_file_goes_on_where_it_was_stopped() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("rows.jsonl");
        let header = Header::new(serde_json::json!({ "samples": 100 })).expect("this test can be read");
        let row = Row { answer: answer("axis", vec![], vec![claim("creep", None, true, 0.97)]) };
        let kept = Kept::open(&path, &header).expect("it is new");
        kept.add(key(1), &row).expect("it is written");
        kept.add(key(2), &row).expect("it is written");
        let text = std::fs::read_to_string(&path).expect("it is there");
        let within_a_character = [&text.as_bytes()[..text.len() - 20], &"é".as_bytes()[..1]].concat();
        std::fs::write(&path, within_a_character).expect("it is cut");
        let again = Kept::<Row>::open(&path, &header).expect("the same configuration");
        assert_eq!((again.row(&key(1)), again.row(&key(2))), (Some(row.clone()), None));
        again.add(key(2), &row).expect("it is written");
        let whole = std::fs::read(&path).expect("it is there");
        assert_eq!(Kept::<Row>::open(&path, &header).expect("once more").row(&key(2)), Some(row.clone()));
        assert_eq!(std::fs::read(&path).expect("it is there"), whole);
        assert_eq!(answers(folder.path()).expect("two rows"), [row.answer.clone(), row.answer]);
        let other = Header { configuration: serde_json::json!({ "samples": 200 }), ..header };
        assert!(Kept::<Row>::open(&path, &other).is_err(), "another configuration");
    }
}
