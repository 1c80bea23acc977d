//! Writes the recordings of the tutorial about your own: trials as CSV with decimal commas and a row of units, and all of them in one
//! Parquet file.
//!
//! ```text
//! cargo run -p acm-datasets --example own_recordings -- datasets/own-recordings
//! x(t) = 0.25·sin q(t − 0.08 s), with noise of 0.1 mm
//! ```

#![allow(missing_docs)]

use std::path::{Path, PathBuf};

use acm_datasets::files::table::{Column, write_parquet};

/// Rows of each recording.
pub const ROWS: usize = 250;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("name a folder"));
    german(&folder.join("csv"));
    one_parquet(&folder.join("parquet"));
}

/// Time in s, an angle in rad, and a length in m that follows it 80 ms later; another motion in each trial.
pub fn motion(trial: usize, row: usize) -> [f64; 3] {
    let t = row as f64 / 50.0;
    let angle = |t: f64| {
        let s = t + 40.0 * trial as f64;
        0.8 * (1.7 * s + 2.0 * (0.23 * s).sin()).sin() + 0.4 * (2.9 * s + 2.5 * (0.31 * s).sin()).sin()
    };
    let noise = ((row * 7919 + trial * 104_729) % 1000) as f64 / 1000.0 - 0.5;
    [t, angle(t), 0.25 * angle(t - 0.08).sin() + 2e-4 * noise]
}

/// Writes a text.
///
/// # Panics
/// The file system.
pub fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(path, text).expect("written");
}

/// A CSV whose rows are made of time, angle and length.
pub fn csv(header: &str, trial: usize, row: impl Fn(usize, [f64; 3]) -> String) -> String {
    let rows = (0..ROWS).map(|k| row(k, motion(trial, k)) + "\n");
    format!("{header}\n{}", rows.collect::<String>())
}

/// Writes a Parquet file.
///
/// # Panics
/// The file system.
pub fn parquet(folder: &Path, name: &str, columns: Vec<(&str, Column)>) {
    std::fs::create_dir_all(folder.join(name).parent().expect("a folder")).expect("made");
    let columns: Vec<(String, Column)> = columns.into_iter().map(|(name, column)| (name.to_string(), column)).collect();
    write_parquet(&folder.join(name), &columns).expect("written");
}

pub fn numbers(trials: std::ops::Range<usize>, of: fn(usize, usize) -> f64) -> Column {
    Column::Number(trials.flat_map(|trial| (0..ROWS).map(move |row| of(trial, row))).collect())
}

pub fn german(folder: &Path) {
    for (trial, name) in ["a", "b", "c", "d", "e"].iter().enumerate() {
        let comma = |value: f64| format!("{value:.6}").replace('.', ",");
        let rows =
            csv("Zeit;Winkel;Weg\nms;rad;mm", trial, |_, [t, q, x]| [1000.0 * t, q, 1000.0 * x].map(comma).join(";"));
        write(folder, &format!("run_{name}.csv"), &rows);
    }
}

pub fn one_parquet(folder: &Path) {
    let names = (0..3).flat_map(|trial| vec![format!("take{trial}"); ROWS]).collect();
    let columns = vec![
        ("take", Column::Text(names)),
        ("time", numbers(0..3, |trial, row| motion(trial, row)[0])),
        ("cmd", numbers(0..3, |trial, row| motion(trial, row)[1])),
        ("load", numbers(0..3, |trial, _| trial as f64 / 2.0)),
        ("tip_mm", numbers(0..3, |trial, row| 1000.0 * motion(trial, row)[2])),
        ("mode", numbers(0..3, |_, _| 4.0)),
    ];
    parquet(folder, "log.parquet", columns);
}
