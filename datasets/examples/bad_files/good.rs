//! A small data set that is in order, in CSV or in Parquet, and what spoils it.

use std::fs;
use std::path::{Path, PathBuf};

use acm_datasets::table::{Column, write_parquet};

/// Columns of the recordings: time ms, an actuator deg, a context signal cm, an output mm.
pub const COLUMNS: [&str; 4] = ["t", "q", "h", "y"];

/// Rows of a recording.
pub const ROWS: usize = 60;

pub const MANIFEST: &str = r#"
name = "small"
[table]
files = ["run_*.csv", "run_*.parquet"]
trial = { file = "run_(.*)" }
time = { column = "t", unit = "ms" }
[[actuator]]
column = "q"
unit = "deg"
[[context]]
column = "h"
unit = "cm"
[[measured]]
column = "y"
unit = "mm"
[roles]
calibration = ["d"]
development = ["a", "b"]
held_out = ["c"]
"#;

/// A data set in a folder that disappears with the value. Trial `b` is what is spoiled; `p` is excluded, and in Parquet.
pub struct Set {
    folder: tempfile::TempDir,
}

impl Set {
    pub fn new() -> std::io::Result<Set> {
        let set = Set { folder: tempfile::tempdir()? };
        set.write("data/manifest.toml", MANIFEST.replace("[roles]", "[roles]\nexcluded = [\"p\"]"))?;
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

    pub fn read(&self, name: &str) -> std::io::Result<Vec<u8>> {
        fs::read(self.file(name))
    }
}

/// 60 samples at 10 Hz.
pub fn rows(seed: usize) -> Vec<[f64; 4]> {
    let one = |t: usize| {
        let phase = t as f64 / 7.0 + seed as f64;
        [100.0 * t as f64, (1000.0 * phase.sin()).round() / 100.0, 12.5 + seed as f64, (100.0 * phase.cos()).round()]
    };
    (0..ROWS).map(one).collect()
}

/// Row 2 is the first sample.
pub fn csv(rows: &[[f64; 4]]) -> String {
    let line = |r: &[f64; 4]| format!("{},{},{},{}\n", r[0], r[1], r[2], r[3]);
    COLUMNS.join(",") + "\n" + &rows.iter().map(line).collect::<String>()
}

/// The same rows as a Parquet file.
pub fn parquet(path: &Path, rows: &[[f64; 4]]) {
    let column = |i: usize| Column::Number(rows.iter().map(|r| r[i]).collect());
    let columns: Vec<_> = COLUMNS.iter().enumerate().map(|(i, n)| (n.to_string(), column(i))).collect();
    write_parquet(path, &columns).expect("a table");
}
