//! A small campaign in a temporary folder, made from formulas, and the command to learn from it.
//!
//! | signal  | formula                                             | unit |
//! | ------- | --------------------------------------------------- | ---- |
//! | q1, q2  | 1.2 sin(0.7 t + φ), 0.8 cos(0.45 t + φ)             | rad  |
//! | wind    | 0.5 + 0.5 sin(0.31 t + φ); 0 in calibration         | 1    |
//! | x, y, z | 0.2 q1, 0.15 q2, 0.05 q1 q2; plus wind · 0.03 q̇1 …  | m    |

#![allow(dead_code)] // each test file uses its part

mod program;

use std::{
    fs,
    path::{Path, PathBuf},
};

use acm_train::run::record::{RunRecord, read_records};
use assert_cmd::Command;
use tempfile::TempDir;

pub use program::program;

/// Samples per trial, at 10 Hz.
pub const SAMPLES: usize = 90;

/// Trials and roles: calibration c1, development d1 to d3, held out h1 and h2.
pub const TRIALS: [&str; 6] = ["c1", "d1", "d2", "d3", "h1", "h2"];

/// The campaign's folder; removed when dropped.
pub struct Campaign {
    /// Holds `data/`, `experiment.toml` and whatever runs write.
    pub folder: TempDir,
}

/// What the tip measures at a sample: trial index, sample index → x, y, z.
pub type Tip = fn(usize, usize) -> [f64; 3];

impl Campaign {
    /// The campaign of the formulas above.
    pub fn new() -> Self {
        Self::with(tip)
    }

    /// The same commands with other measurements.
    pub fn with(tip: Tip) -> Self {
        let campaign = Self { folder: tempfile::tempdir().unwrap() };
        fs::create_dir(campaign.path("data")).unwrap();
        campaign.write("data/manifest.toml", MANIFEST);
        for (trial, name) in TRIALS.iter().enumerate() {
            campaign.write(&format!("data/{name}.csv"), &table(trial, tip));
        }
        campaign.write("tiny.toml", EXPERIMENT);
        campaign
    }

    /// A path below the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file below the folder.
    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Reads a file below the folder.
    pub fn read(&self, name: &str) -> Vec<u8> {
        let path = self.path(name);
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// `acm-train --config tiny.toml …` in the folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.program();
        command.args(["--config", "tiny.toml"]).args(arguments);
        command
    }

    /// `acm-train` in the folder.
    pub fn program(&self) -> Command {
        let mut command = Command::new(program());
        command.current_dir(self.folder.path());
        command
    }

    /// Runs `acm-train --config tiny.toml --out <out> …` to the end.
    pub fn learn(&self, out: &str, arguments: &[&str]) -> Vec<RunRecord> {
        self.command(&["--out", out]).args(arguments).assert().success();
        read_records(&self.path(out)).unwrap()
    }
}

/// Everything of a record but how long it took.
pub fn timeless(records: Vec<RunRecord>) -> Vec<RunRecord> {
    records.into_iter().map(|record| RunRecord { seconds: 0.0, ..record }).collect()
}

/// Every file below a folder of checkpoints, predictions and the log, with its bytes.
pub fn bytes_below(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = vec![("training.log".into(), fs::read(folder.join("training.log")).unwrap())];
    for part in ["predictions", "checkpoints"] {
        let mut names: Vec<PathBuf> =
            fs::read_dir(folder.join(part)).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.sort();
        for path in names {
            files.push((path.strip_prefix(folder).unwrap().into(), fs::read(&path).unwrap()));
        }
    }
    files
}

/// Actuators and wind.
pub fn inputs(trial: usize, k: usize) -> [f64; 3] {
    let (t, phase) = (k as f64 / 10.0, trial as f64);
    let wind = if trial == 0 { 0.0 } else { 0.5 + 0.5 * (0.31 * t + phase).sin() };
    [1.2 * (0.7 * t + phase).sin(), 0.8 * (0.45 * t + phase).cos(), wind]
}

/// The formula of the tip.
pub fn tip(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, wind] = inputs(trial, k);
    let rate = 1.2 * 0.7 * (0.7 * k as f64 / 10.0 + trial as f64).cos();
    [0.2 * q1 + 0.03 * wind * rate, 0.15 * q2 + 0.02 * wind, 0.05 * q1 * q2 - 0.03 * wind * q1]
}

fn table(trial: usize, tip: Tip) -> String {
    let row = |k: usize| {
        let ([q1, q2, wind], [x, y, z]) = (inputs(trial, k), tip(trial, k));
        format!("{},{q1},{q2},{wind},{x},{y},{z}\n", k as f64 / 10.0)
    };
    std::iter::once("t,q1,q2,wind,x,y,z\n".to_string()).chain((0..SAMPLES).map(row)).collect()
}

pub const MANIFEST: &str = r#"
name      = "formulas"
title     = "A small campaign of formulas"
licence   = "CC0"
source    = "written by a test"
synthetic = true

[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q1"
unit   = "rad"
[[actuator]]
column = "q2"
unit   = "rad"

[[context]]
column = "wind"
unit   = "1"

[[measured]]
column = "x"
unit   = "m"
[[measured]]
column = "y"
unit   = "m"
[[measured]]
column = "z"
unit   = "m"

[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3"]
held_out    = ["h1", "h2"]

[folds]
validation = [["d1"], ["d2"], ["d3"]]
"#;

pub const EXPERIMENT: &str = r#"
question = "Does the whole way run?"
data     = "data"

[inputs]
domain_filter = "none"

[windows]
length = 5
reach  = 5

[network]
kind  = "gru"
units = 4

[training]
epochs = 3
batch  = 16

[protocol]
seeds = [1, 2]
"#;
