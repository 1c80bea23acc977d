//! Studies that describe: on the embedded campaign, on planted ones, and asked wrongly.

#[path = "../campaign/mod.rs"]
mod campaign;

mod nominal;
mod planted;
mod refusals;
mod residual;

use std::{collections::BTreeMap, path::Path};

use acm_datasets::files::table::{Column, read_parquet};
use assert_cmd::Command;
use serde_json::Value;

/// A table by column; the arithmetic of these tests is plain loops over slices.
struct Table {
    columns: BTreeMap<String, Column>,
}

impl Table {
    /// Reads a Parquet file.
    fn read(path: &Path) -> Self {
        Self { columns: read_parquet(path).unwrap().into_iter().collect() }
    }

    /// A column of numbers.
    fn numbers(&self, name: &str) -> &[f64] {
        self.columns.get(name).and_then(Column::numbers).unwrap_or_else(|| panic!("no numbers in {name}"))
    }

    /// A column of words.
    fn text(&self, name: &str) -> &[String] {
        self.columns.get(name).and_then(Column::text).unwrap_or_else(|| panic!("no text in {name}"))
    }

    /// Whether there is such a column.
    fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    /// Root of the mean over `rows` of Σ (a_o − b_o)² over `outputs`.
    fn rms(&self, a: &str, b: &str, outputs: &[&str], rows: &[usize]) -> f64 {
        let mut sum = 0.0;
        for output in outputs {
            let (a, b) = (self.numbers(&format!("{a}_{output}")), self.numbers(&format!("{b}_{output}")));
            for &row in rows {
                sum += (a[row] - b[row]) * (a[row] - b[row]);
            }
        }
        (sum / rows.len() as f64).sqrt()
    }

    /// Rows of the trials that are wanted.
    fn rows(&self, wanted: impl Fn(&str) -> bool) -> Vec<usize> {
        let trials = self.text("trial");
        (0..trials.len()).filter(|&row| wanted(&trials[row])).collect()
    }
}

/// Runs a study of `experiments/` into a temporary folder; what it printed.
fn conduct(name: &str, out: &Path) -> String {
    let file = std::path::absolute("../experiments").unwrap().join(name);
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
    let output = command.arg("--config").arg(file).arg("--out").arg(out).arg("--quiet").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// `study.json` as any program reads it.
fn study(out: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(out.join("study.json")).unwrap()).unwrap()
}

/// The record says what the table says.
#[track_caller]
fn close(said: &Value, computed: f64, what: &str) {
    let said = said.as_f64().unwrap_or_else(|| panic!("{what} is no number: {said}"));
    assert!((said - computed).abs() < 1e-12, "{what}: the record says {said}, the table {computed}");
}

/// An object's components and total against a table.
#[track_caller]
fn agrees(rms: &Value, table: &Table, estimate: &str, rows: &[usize], what: &str) {
    assert_eq!(rms["samples"], rows.len(), "{what}");
    for (o, output) in ["x", "y", "z"].into_iter().enumerate() {
        close(&rms["components"][o], table.rms("measured", estimate, &[output], rows), what);
    }
    close(&rms["total"], table.rms("measured", estimate, &["x", "y", "z"], rows), what);
}
