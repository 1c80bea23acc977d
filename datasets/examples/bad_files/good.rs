//! A small data set that is in order, in CSV or in Parquet, and what spoils it.

use std::fs;
use std::path::PathBuf;

#[path = "rows.rs"]
mod table;

pub use table::{COLUMNS, MANIFEST, csv, parquet, rows};

/// A data set in a folder that disappears with the value. Trial `b` is what is spoiled; `p` is excluded, and in Parquet.
pub struct Set {
    folder: tempfile::TempDir,
}

impl Set {
    pub fn new() -> std::io::Result<Set> {
        let set = Set { folder: tempfile::tempdir()? };
        let both = MANIFEST.replace("\"run_*.csv\"", "\"run_*.csv\", \"run_*.parquet\"");
        set.write("data/manifest.toml", both.replace("[roles]", "[roles]\nexcluded = [\"p\"]"))?;
        for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
            set.write(&format!("data/run_{name}.csv"), csv(&rows(i)))?;
        }
        parquet(&set.file("data/run_p.parquet"), &rows(4));
        Ok(set)
    }

    /// The folder of the manifest and the recordings.
    pub fn path(&self) -> PathBuf {
        self.file("data")
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> std::io::Result<()> {
        let path = self.file(name);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::write(path, contents)
    }

    /// Replaces the first place of a text in a file, which must hold it.
    pub fn edit(&self, name: &str, from: &str, to: &str) -> std::io::Result<()> {
        let text = String::from_utf8_lossy(&self.read(name)?).into_owned();
        assert!(text.contains(from), "{name} has no {from:?}");
        self.write(name, text.replacen(from, to, 1))
    }

    pub fn read(&self, name: &str) -> std::io::Result<Vec<u8>> {
        fs::read(self.file(name))
    }
}
