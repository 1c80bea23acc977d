//! A robot of formulas, and a small network that is trained on it.
//!
//! | signal | formula                                  | unit |
//! | ------ | ---------------------------------------- | ---- |
//! | q1, q2 | 60 sin(0.7 t + φ), 40 cos(0.45 t + φ)    | deg  |
//! | wind   | 50 + 40 sin(0.31 t + φ)                  | %    |
//! | x, y   | of q1, q2 two samples ago, and of wind   | mm   |
//!
//! 10 Hz with jitter, and a gap of 1 s in each trial.

use std::{
    fs,
    path::{Path, PathBuf},
};

use acm_core::{
    NominalSpec,
    augmented::AugmentedModel,
    calibrate,
    effects::{Carrier, instance::Term},
};
use acm_datasets::{Campaign, Role, Trial, rig::rig};
use acm_train::{
    config::read,
    run::{progress::Progress, record::RunRecord, stop::Stop},
    schedule::{job, request::Request},
    store::hashed,
};
use assert_cmd::Command;
use tempfile::TempDir;

pub const SAMPLES: usize = 120;
pub const TRIALS: [&str; 6] = ["c1", "d1", "d2", "d3", "h1", "h2"];

pub struct Robot {
    pub folder: TempDir,
}

pub fn time(k: usize) -> f64 {
    0.1 * k as f64 + 0.02 * (1.7 * k as f64).sin() + if k > 70 { 1.0 } else { 0.0 }
}

pub fn row(trial: usize, k: usize) -> String {
    // In calibration q1 goes less far: the filter takes out the ends of its travel.
    let width = if trial == 0 { 57.0 } else { 60.0 };
    let at = |t: f64| [width * (0.7 * t + trial as f64).sin(), 40.0 * (0.45 * t + trial as f64).cos()];
    let (t, late) = (time(k), time(k.saturating_sub(2)));
    let ([q1, q2], [a, b]) = (at(t), at(late));
    let wind = if trial == 0 { 10.0 } else { 50.0 + 40.0 * (0.31 * t + trial as f64).sin() };
    let (x, y) = (2.0 * a + 0.3 * wind, 1.5 * b + 0.01 * a * b + 0.002 * wind * a);
    format!("{t},{q1},{q2},{wind},{x},{y}\n")
}

pub const HEADER: &str = "t,q1,q2,w,x,y\n";

impl Robot {
    pub fn new() -> Self {
        let robot = Self { folder: tempfile::tempdir().unwrap() };
        fs::create_dir(robot.path("data")).unwrap();
        robot.write("data/manifest.toml", MANIFEST);
        robot.write("gru.toml", EXPERIMENT);
        for (trial, name) in TRIALS.iter().enumerate() {
            robot.write(&format!("data/{name}.csv"), &table(trial));
        }
        robot
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Trains, with a model with effects where one is asked for.
    pub fn learn(&self, augmented: bool) -> Vec<RunRecord> {
        self.learn_with(augmented, &[])
    }

    /// The same with edits of the experiment.
    pub fn learn_with(&self, augmented: bool, edits: &[&str]) -> Vec<RunRecord> {
        let edits: Vec<String> = edits.iter().map(ToString::to_string).collect();
        let (mut experiment, source) = read(&self.path("gru.toml"), &edits).unwrap();
        experiment.nominal.augmented = augmented.then(|| "model.json".into());
        let (out, progress, stop) = (self.path("run"), Progress::Quiet, Stop::default());
        let request = Request::new(&out, &progress, &stop);
        job::run(experiment, &source, &request).unwrap()
    }

    /// The calibrated polynomial, with a lag and a play that grows with the wind.
    pub fn save_model(&self) {
        self.save_model_late(0.0);
    }

    /// The same where the actuators' clock is late, s.
    pub fn save_model_late(&self, late: f64) {
        let data = Campaign::read(&self.path("data"), None).unwrap();
        let calibration: Vec<&Trial> = data.trials(Role::Calibration).collect();
        let fitted = calibrate(&NominalSpec::Polynomial { degree: 2 }, &data.observations(&calibration)).unwrap();
        let all: Vec<&Trial> = data.trials.iter().collect();
        let term = |effect: &str, context, values: &[f64]| Term {
            effect: effect.into(),
            carrier: Carrier::Rig,
            context,
            values: values.to_vec(),
            definition: None,
        };
        let play = term("backlash", Some(Carrier::Context(0)), &[0.02, 0.01, 0.03, 0.0]);
        let effects = vec![term("dead_time", None, &[0.2]), play, term("measurement_lag", None, &[0.1])];
        let model = AugmentedModel::new(rig(&data, &all), fitted.model, None, None, effects).unwrap();
        let model = model.with_clock_correction(late);
        self.write("model.json", str::from_utf8(&hashed::encode(&model).unwrap()).unwrap());
    }

    pub fn stream(&self, arguments: &[&str], lines: impl AsRef<[u8]>) -> (i32, String, String) {
        self.ask("stream", arguments, lines)
    }

    /// Any command of acm-eval: exit code, standard output, standard error.
    pub fn ask(&self, name: &str, arguments: &[&str], lines: impl AsRef<[u8]>) -> (i32, String, String) {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"));
        command.current_dir(self.folder.path()).arg(name).args(arguments).write_stdin(lines.as_ref().to_vec());
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
    }
}

/// Compiles the self-test of an export, and runs it.
pub fn self_test(folder: &Path, name: &str) {
    let program = folder.join("self-test");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-DSELFTEST"];
    let source = folder.join(format!("{name}.c"));
    let Ok(built) = std::process::Command::new("gcc").args(flags).arg(&source).arg("-o").arg(&program).output() else {
        return eprintln!("skipped: gcc is not installed");
    };
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let output = std::process::Command::new(program).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    println!("{name}.c: {}", said.trim());
    assert!(output.status.success(), "{said}");
}

pub fn table(trial: usize) -> String {
    std::iter::once(HEADER.to_string()).chain((0..SAMPLES).map(|k| row(trial, k))).collect()
}

pub const MANIFEST: &str = r#"
name      = "formulas"
title     = "A robot of formulas"
synthetic = true

[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q1"
unit   = "deg"
[[actuator]]
column = "q2"
unit   = "deg"

[[context]]
column = "w"
name   = "wind"
unit   = "%"

[[measured]]
column = "x"
unit   = "mm"
[[measured]]
column = "y"
unit   = "mm"

[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3"]
held_out    = ["h1", "h2"]

[folds]
validation = [["d1"], ["d2"], ["d3"]]
"#;

pub const EXPERIMENT: &str = r#"
question = "Does a stream answer as the run was scored?"
data     = "data"

[inputs]
channels      = ["q1", "rate(q1)", "wind"]
domain_filter = "box"

[windows]
length = 6
reach  = 6

[network]
kind  = "gru"
units = 5

[training]
epochs = 4
batch  = 16
output_layer = "random"

[protocol]
seeds = [1]
"#;
