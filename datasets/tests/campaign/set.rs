//! A small set that is in order: two development trials, one held out and one for calibration. Tests spoil it.

use std::path::{Path, PathBuf};

use acm_datasets::table::{Column, write_parquet};
use acm_datasets::{Campaign, DataError};

pub const MANIFEST: &str = r#"
name = "small"
[table]
files = ["run_*.csv"]
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

/// 60 samples at 10 Hz: time ms, q deg, h cm, y mm.
pub fn rows(seed: usize) -> Vec<[f64; 4]> {
    let one = |t: usize| {
        let phase = t as f64 / 7.0 + seed as f64;
        [100.0 * t as f64, (1000.0 * phase.sin()).round() / 100.0, 12.5 + seed as f64, (100.0 * phase.cos()).round()]
    };
    (0..60).map(one).collect()
}

/// Line 2 is the first sample: `0,…`.
pub fn csv(rows: &[[f64; 4]]) -> String {
    let line = |r: &[f64; 4]| format!("{},{},{},{}\n", r[0], r[1], r[2], r[3]);
    "t,q,h,y\n".to_string() + &rows.iter().map(line).collect::<String>()
}

/// The same rows as a Parquet file.
pub fn parquet(path: &Path, rows: &[[f64; 4]]) {
    let column = |i: usize| Column::Number(rows.iter().map(|r| r[i]).collect());
    let columns: Vec<_> = ["t", "q", "h", "y"].iter().enumerate().map(|(i, n)| (n.to_string(), column(i))).collect();
    write_parquet(path, &columns).expect("parquet");
}
