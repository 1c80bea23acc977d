//! A small set that is in order: two development trials, one held out and one for calibration. Tests spoil it.

use std::path::{Path, PathBuf};

use acm_datasets::{Campaign, DataError};

#[path = "../../examples/bad_files/rows.rs"]
mod table;

pub use table::{MANIFEST, csv, parquet, rows};

/// A folder that disappears with the value.
pub struct Set {
    folder: tempfile::TempDir,
}

impl Set {
    pub fn new() -> Set {
        let set = Set { folder: tempfile::tempdir().expect("temporary folder") };
        set.write("manifest.toml", MANIFEST);
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            set.write(&format!("run_{name}.csv"), &csv(&rows(i)));
        }
        set
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) -> &Set {
        std::fs::write(self.file(name), text).expect("write");
        self
    }

    /// Replaces text in a file, which must hold it.
    pub fn edit(&self, name: &str, from: &str, to: &str) -> &Set {
        let text = std::fs::read_to_string(self.file(name)).expect("read");
        assert!(text.contains(from), "{name} has no {from:?}:\n{text}");
        self.write(name, &text.replacen(from, to, 1))
    }

    pub fn read(&self) -> Result<Campaign, DataError> {
        Campaign::read(self.path(), None)
    }

    pub fn campaign(&self) -> Campaign {
        self.read().unwrap_or_else(|e| panic!("{e}"))
    }

    pub fn error(&self) -> String {
        self.read().err().map_or_else(|| panic!("the set was read"), |e| e.to_string())
    }
}
