//! A network that corrects the actuators beside the tip: what it learns, and that a stream answers as it was scored.
//!
//! An arm of constant curvature in closed form, whose actuators are off by an amount that grows with the wind:
//!
//! ```text
//! β = 0.9 (q + [0.25, −0.2] w)     x = L (1 − cos θ)/θ² β₁     y = L (1 − cos θ)/θ² β₂     z = −L sin θ / θ     θ = |β|
//! ```

use std::{fs, path::Path};

use acm_core::augmented::AugmentedModel;
use acm_datasets::{Trial, rig::rig};
use acm_eval::run::predictions::{HELD_OUT, Predictions};
use acm_train::{
    config::read,
    run::nominal::augmented::origin,
    run::record::{RunRecord, read_nominal},
    run::{progress::Progress, stop::Stop},
    schedule::{job, request::Request},
    store::hashed,
};
use assert_cmd::Command;

const LENGTH: f64 = 0.5;
const SAMPLES: usize = 150;
const TRIALS: [&str; 5] = ["c1", "d1", "d2", "d3", "h1"];

fn row(trial: usize, k: usize) -> String {
    let (t, phase) = (0.1 * k as f64, trial as f64);
    let q = [1.1 * (0.7 * t + phase).sin(), 0.9 * (0.45 * t + 2.0 * phase).cos()];
    let wind = if trial == 0 { 0.0 } else { (0.23 * t + phase).sin() };
    let beta = [0.9 * (q[0] + 0.25 * wind), 0.9 * (q[1] - 0.2 * wind)];
    let theta = beta[0].hypot(beta[1]);
    let radial = LENGTH * (1.0 - theta.cos()) / theta.powi(2);
    let tip = [radial * beta[0], radial * beta[1], -LENGTH * theta.sin() / theta];
    format!("{t},{},{},{wind},{},{},{}\n", q[0], q[1], tip[0], tip[1], tip[2])
}

fn table(trial: usize) -> String {
    std::iter::once("t,q1,q2,w,x,y,z\n".to_string()).chain((0..SAMPLES).map(|k| row(trial, k))).collect()
}

fn campaign(folder: &Path) {
    fs::create_dir(folder.join("data")).unwrap();
    fs::write(folder.join("data/manifest.toml"), MANIFEST).unwrap();
    fs::write(folder.join("mlp.toml"), EXPERIMENT).unwrap();
    for (trial, name) in TRIALS.iter().enumerate() {
        fs::write(folder.join(format!("data/{name}.csv")), table(trial)).unwrap();
    }
}

fn learned(folder: &Path, out: &str, corrects: &str) -> RunRecord {
    let edits = [format!("network.corrects={corrects}")];
    let (experiment, source) = read(&folder.join("mlp.toml"), &edits).unwrap();
    let (out, progress, stop) = (folder.join(out), Progress::Quiet, Stop::default());
    job::run(experiment, &source, &Request::new(&out, &progress, &stop)).unwrap().remove(0)
}

fn error(record: &RunRecord, of: &str) -> f64 {
    record.held_out.as_ref().unwrap().estimators[of].rmse_total
}

fn stream_answers_as_scored(folder: &Path, run: &str, record: &RunRecord) {
    let scored = Predictions::read(&folder.join(run).join(&record.predictions), &record.outputs).unwrap();
    let mut stream = Command::new(assert_cmd::cargo::cargo_bin!("acm-eval"));
    stream.current_dir(folder).args(["stream", run, "--windows"]).write_stdin(table(4));
    let output = stream.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let answers = String::from_utf8(output.stdout).unwrap();
    let cells = |line: &str| line.split(',').take(4).map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let answers: Vec<Vec<f64>> = answers.lines().skip(1).map(cells).collect();
    for rows in scored.trials(HELD_OUT) {
        for row in rows.rows {
            let answer = answers.iter().find(|cells| cells[0] == scored.time()[row]).unwrap();
            for (o, output) in ["x", "y", "z"].iter().enumerate() {
                let off = (answer[1 + o] - scored.column("predicted", output)[row]).abs();
                assert!(off < 1e-6, "{output} at {} s: off by {off} m", answer[0]);
            }
        }
    }
}

#[test]
fn actuators_are_corrected_where_they_are_off_and_a_stream_answers_alike() {
    let folder = tempfile::tempdir().unwrap();
    campaign(folder.path());
    let tip = learned(folder.path(), "tip", "[\"tip\"]");
    let both = learned(folder.path(), "both", "[\"tip\",\"actuators\"]");
    let (nominal, of_tip, of_both) = (error(&tip, "nominal"), error(&tip, "mlp"), error(&both, "mlp"));
    assert!(nominal > 0.02 && of_tip < 0.6 * nominal, "nominal {nominal}, tip {of_tip}");
    assert!(of_both < 0.8 * of_tip, "nominal {nominal}, tip {of_tip}, both {of_both}");

    stream_answers_as_scored(folder.path(), "both", &both);
}

/// The calibrated arm as a loop saves it, without an effect: what is learned upon it is what is learned upon the arm, and the
/// stream answers alike.
#[test]
fn actuators_are_corrected_upon_a_saved_model_too() {
    let folder = tempfile::tempdir().unwrap();
    campaign(folder.path());
    let plain = learned(folder.path(), "plain", "[\"tip\",\"actuators\"]");
    save(folder.path(), "plain");
    let text = fs::read_to_string(folder.path().join("mlp.toml")).unwrap();
    fs::write(folder.path().join("mlp.toml"), format!("{text}\n[nominal]\naugmented = \"model.json\"\n")).unwrap();
    let upon = learned(folder.path(), "upon", "[\"tip\",\"actuators\"]");
    let (a, b) = (error(&plain, "mlp"), error(&upon, "mlp"));
    assert!((a - b).abs() < 0.01 * a, "{a} m and {b} m");
    stream_answers_as_scored(folder.path(), "upon", &upon);
}

/// Saves the calibrated arm of a run as a model with effects.
fn save(folder: &Path, run: &str) {
    let data = acm_datasets::Campaign::read(&folder.join("data"), None).unwrap();
    let calibrated = read_nominal(&folder.join(run)).unwrap().calibrations.remove("calibration").unwrap();
    let all: Vec<&Trial> = data.trials.iter().collect();
    let model = AugmentedModel::new(rig(&data, &all), calibrated.nominal.unwrap().model, None, None, vec![]).unwrap();
    let model = model.clone().with_origin(origin(&model, &data));
    fs::write(folder.join("model.json"), hashed::encode(&model).unwrap()).unwrap();
}

/// A polynomial has no actuators to correct.
#[test]
fn what_is_no_arm_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    campaign(folder.path());
    let edits = ["network.corrects=[\"tip\",\"actuators\"]".to_string(), "nominal.model=polynomial".to_string()];
    let error = read(&folder.path().join("mlp.toml"), &edits).unwrap_err().to_string();
    assert!(error.contains("network.corrects") && error.contains("is no arm"), "{error}");
}

const MANIFEST: &str = r#"
name      = "arc"
title     = "An arm of constant curvature with actuators that are off"
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
column = "w"
name   = "wind"
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

[arm]
length       = { value = 0.5, unit = "m" }
axis         = "-z"
strain       = { basis = "legendre", order = 0 }
actuation    = { degree = 1 }
registration = { kind = "fixed" }

[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3"]
held_out    = ["h1"]

[folds]
validation = [["d1"], ["d2"], ["d3"]]
"#;

const EXPERIMENT: &str = r#"
question = "Are the actuators off?"
data     = "data"

[inputs]
channels      = ["q1", "q2", "wind"]
domain_filter = "none"

[windows]
length = 2
reach  = 2

[network]
kind = "mlp"

[training]
epochs        = 25
learning_rate = 3e-3

[protocol]
seeds = [1]
"#;
