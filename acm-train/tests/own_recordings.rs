//! The command of the book's chapter on your own recordings, on tables that a robot might have left.

mod campaign;

use std::{fs, path::Path};

use acm_train::run::record::{RunRecord, read_records};
use assert_cmd::Command;

const SAMPLES: usize = 220;

fn chapter() -> String {
    fs::read_to_string("../book/src/own-recordings.md").unwrap()
}

/// A manifest of an arm.
fn manifest() -> String {
    MANIFEST.to_string()
}

const MANIFEST: &str = r#"name     = "my-arm"
title    = "My arm, OptiTrack"
licence  = "CC-BY-4.0"
source   = "my lab, 2026-11-03"
synthetic = false

[table]
files = ["run_*.csv"]
trial = { file = "run_(.*)" }              # the trial's name, from the file's
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q1"
unit   = "deg"

[[measured]]
column = "tip_x"
unit   = "mm"
name   = "x"
[[measured]]
column = "tip_y"
unit = "mm"
name = "y"
[[measured]]
column = "tip_z"
unit = "mm"
name = "z"

[arm]                                      # leave out for a polynomial instead of a strain model
length = { value = 0.40, unit = "m" }
axis   = "-z"                              # roughly where the straight arm points
strain = { basis = "legendre", order = 1 } # or { basis = "piecewise", segments = 3 }

[roles]
calibration = ["a"]
development = ["b", "c", "d"]
held_out    = ["e"]
"#;

/// A tip that follows its motor late, and with a wobble.
fn table(trial: usize) -> String {
    let angle = |t: f64| 25.0 * (0.6 * t + trial as f64).sin() + 10.0 * (1.7 * t).cos();
    let row = |k: usize| {
        let t = 0.05 * k as f64;
        let (q, late) = (angle(t), angle(t - 0.1).to_radians());
        let (x, z) = (200.0 * late.sin(), -400.0 + 120.0 * (1.0 - late.cos()));
        format!("{t:.3},{q:.5},{x:.4},{:.4},{z:.4}\n", 3.0 * (2.0 * t).sin())
    };
    std::iter::once("t,q1,tip_x,tip_y,tip_z\n".to_string()).chain((0..SAMPLES).map(row)).collect()
}

/// The words of the chapter behind `cargo run -p acm-train --`.
fn arguments(folder: &Path) -> Vec<String> {
    let chapter = chapter();
    let (_, command) = chapter.split_once("cargo run -p acm-train -- ").expect("the command");
    let words = command.lines().next().unwrap_or_default().split(' ');
    words.map(|word| word.replace("data=my-robot", &format!("data={}", folder.display()))).collect()
}

/// In a copy of the repository's experiments, as a user has them.
fn learn(folder: &Path, trials: &[&str], manifest: &str) -> Vec<RunRecord> {
    let experiments = std::path::absolute("../experiments").unwrap();
    fs::create_dir_all(folder.join("experiments")).unwrap();
    fs::copy(experiments.join("my-robot.toml"), folder.join("experiments/my-robot.toml")).unwrap();
    let data = folder.join("my recordings");
    fs::create_dir(&data).unwrap();
    fs::write(data.join("manifest.toml"), manifest).unwrap();
    for (k, trial) in trials.iter().enumerate() {
        fs::write(data.join(format!("run_{trial}.csv")), table(k)).unwrap();
    }
    let quick = ["--set", "training.epochs=2", "--set", "protocol.seeds=[1]"];
    Command::new(campaign::program()).current_dir(folder).args(arguments(&data)).args(quick).assert().success();
    read_records(&folder.join("runs/my-robot")).unwrap()
}

#[test]
fn the_chapter_leads_to_a_result() {
    let folder = tempfile::tempdir().unwrap();
    let records = learn(folder.path(), &["a", "b", "c", "d", "e"], &manifest());
    // Each of the three development trials is left out once, and the final run learns from all trials.
    let (last, folds) = records.split_first().unwrap();
    assert_eq!((folds.len(), last.id.as_str()), (3, "final-seed1"));
    assert_eq!(last.channels, ["q1", "rate(q1)"]);
    assert_eq!((last.split.training.len(), last.split.validation.len()), (4, 0));
    assert!(folds.iter().all(|fold| (fold.split.training.len(), fold.split.validation.len()) == (3, 1)));
    let errors = &last.held_out.as_ref().unwrap().trials;
    assert_eq!(errors.keys().collect::<Vec<_>>(), ["e"]);
}

/// Trials that are called as those of the synthetic campaign are.
#[test]
fn trials_may_be_called_anything() {
    let folder = tempfile::tempdir().unwrap();
    let roles = [("[\"a\"]", "[\"9\"]"), ("[\"b\", \"c\", \"d\"]", "[\"1\", \"2\"]"), ("[\"e\"]", "[\"17\"]")];
    let manifest = roles.iter().fold(manifest(), |text, (from, to)| text.replace(from, to));
    let records = learn(folder.path(), &["9", "1", "2", "17"], &manifest);
    assert_eq!(records[0].held_out.as_ref().unwrap().trials.keys().collect::<Vec<_>>(), ["17"]);
}

/// The folds of an experiment of other data say what to do.
#[test]
fn folds_of_other_data_are_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    learn(folder.path(), &["a", "b", "c", "d", "e"], &manifest());
    let cfc = std::path::absolute("../experiments/paper/cfc.toml").unwrap();
    let mut command = Command::new(campaign::program());
    command.current_dir(folder.path()).arg("--config").arg(cfc).args(["--set", "data=my recordings"]);
    let output = command.args(["--set", "inputs.channels=[\"q1\"]"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    let told = told.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    assert!(told.contains("fold 0 names trial \"1\"") && told.contains("delete `folds`"), "{told}");
}
