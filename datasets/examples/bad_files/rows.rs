//! The rows of a small data set that is in order, and its manifest.

use std::path::Path;

use acm_datasets::files::table::{Column, write_parquet};

/// Columns of the recordings: time ms, an actuator deg, a context signal cm, an output mm.
pub const COLUMNS: [&str; 4] = ["t", "q", "h", "y"];

/// Rows of a recording.
const ROWS: usize = 60;

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
