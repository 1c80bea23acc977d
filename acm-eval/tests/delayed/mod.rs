//! A rig with one actuator and one output, whose output is late: the nominal model does not know that.
//!
//! ```text
//! x(t) = 0.1 q(t − 0.3 s) + 0.02 q(t − 0.3 s)² + noise of 0.5 mm,   q(t) = Σ a sin(ω t + φ)
//! ```
//!
//! | trial | role | speed |
//! | --- | --- | --- |
//! | c1 | calibration | a hundredth of the others: a delay does not show |
//! | d1 … d4 | development | three frequencies |
//! | h1, h2 | held out | the same, other phases |

#![allow(dead_code)] // each test file uses its part

use std::{
    fs,
    path::{Path, PathBuf},
};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// What the nominal model lacks, s.
pub const DELAY: f64 = 0.3;

/// Standard deviation of the noise, mm.
pub const NOISE_MM: f64 = 0.5;

const SAMPLES: usize = 400;
const RATE: f64 = 20.0;

/// The data set in a temporary folder; removed when dropped.
pub struct Rig {
    /// Holds `arm/` and whatever is written.
    pub folder: TempDir,
}

impl Rig {
    /// With the delay.
    pub fn new() -> Self {
        Self::with(DELAY)
    }

    /// With another delay; 0 is a rig that lacks nothing.
    pub fn with(delay: f64) -> Self {
        let rig = Self { folder: tempfile::tempdir().unwrap() };
        fs::create_dir(rig.path("arm")).unwrap();
        rig.write("arm/manifest.toml", MANIFEST);
        for (trial, name) in ["c1", "d1", "d2", "d3", "d4", "h1", "h2"].into_iter().enumerate() {
            rig.write(&format!("arm/{name}.csv"), &table(trial, delay));
        }
        rig
    }

    /// A path below the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file below the folder.
    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// `acm-eval` in the folder.
    pub fn program(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"));
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    /// `acm-eval close-loop … --out <out>`, to the end; what it printed, and its loop.json.
    pub fn close(&self, arguments: &[&str], out: &str) -> (String, Value) {
        let done = self.program(&["close-loop"]).args(arguments).args(["--out", out]).assert().success();
        let printed = String::from_utf8(done.get_output().stdout.clone()).unwrap();
        (printed, read_json(&self.path(out).join("loop.json")))
    }
}

/// A JSON file.
pub fn read_json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn command(trial: usize, t: f64) -> f64 {
    let (phase, slow) = (1.7 * trial as f64, if trial == 0 { 0.1 } else { 1.0 });
    let part = |size: f64, omega: f64, shift: f64| size * (omega * slow * t + shift * phase).sin();
    part(0.6, 0.9, 1.0) + part(0.35, 2.3, 2.1) + part(0.2, 5.1, 0.6)
}

fn table(trial: usize, delay: f64) -> String {
    // Twelve uniform numbers make a normal one. Park & Miller (1988), CACM 31(10).
    let mut state = 1000 + trial as u64;
    let mut uniform = || {
        state = state * 48271 % 2_147_483_647;
        state as f64 / 2_147_483_647.0
    };
    let row = |k: usize| {
        let t = k as f64 / RATE;
        let late = command(trial, t - delay);
        let noise: f64 = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let x = 0.1 * late + 0.02 * late * late + 1e-3 * NOISE_MM * noise;
        format!("{t},{},{x}\n", command(trial, t))
    };
    std::iter::once("t,q,x\n".to_string()).chain((0..SAMPLES).map(row)).collect()
}

pub const MANIFEST: &str = r#"
name      = "late-arm"
title     = "An arm that is late"
licence   = "CC0"
source    = "written by a test"
synthetic = true

[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q"
unit   = "rad"

[[measured]]
column = "x"
unit   = "m"

[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3", "d4"]
held_out    = ["h1", "h2"]
"#;
