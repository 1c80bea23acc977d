//! Folds and inputs that the program chooses, on a campaign with planted truth.
//!
//! | signal | formula                                                          | what it is worth               |
//! | ------ | ---------------------------------------------------------------- | ------------------------------ |
//! | q1     | 1.2 sin(0.7 t + φ)                                               | nothing beyond the nominal model |
//! | wind   | 0.5 + 0.5 sin(0.31 t + φ); 0 in calibration                      | 0.05 wind of x                 |
//! | crew   | 1, 2, 3 in d1 and d4, d2 and d5, d3 and d6; 4 in held-out trials | nothing: x of each crew is off by 40, −40 and 0 mm |
//!
//! A model that knows two crews says nothing true of a third, and a fold that leaves out a trial of each does not ask.

mod campaign;

use std::{fs, path::Path};

use acm_train::{
    run::record::{RunRecord, Stage, read_records},
    schedule::study::{record::read, steps},
};
use assert_cmd::Command;
use campaign::program;
use tempfile::TempDir;

const MANIFEST: &str = r#"
name      = "crews"
title     = "Trials of three crews"
licence   = "CC0"
source    = "written by a test"
synthetic = true
actuator  = [{ column = "q1", unit = "rad" }]
context   = [{ column = "wind", unit = "1" }, { column = "crew", unit = "1" }]
measured  = [{ column = "x", unit = "m" }]
[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }
[roles]
calibration = ["c1"]
development = ["d1", "d2", "d3", "d4", "d5", "d6"]
held_out    = ["h1", "h2"]
"#;

const EXPERIMENT: &str = r#"
question = "Which inputs carry the estimate?"
data     = "data"
[inputs]
domain_filter = "none"
select        = true
[windows]
length = 5
reach  = 5
[baseline]
kind   = "boosted_trees"
lags   = [0]
rounds = 60
[protocol]
seeds = [1, 2, 3]
"#;

const STUDY: &str = r#"
study    = "inputs"
question = "Which inputs carry the estimate?"
[[base]]
name       = "trees"
experiment = "trees.toml"
[set.protocol]
seeds = [1]
"#;

/// Trials with their crews.
const TRIALS: [(&str, usize); 9] =
    [("c1", 0), ("d1", 1), ("d2", 2), ("d3", 3), ("d4", 1), ("d5", 2), ("d6", 3), ("h1", 4), ("h2", 4)];

/// Error of x of each crew, m.
const OFFSETS: [f64; 5] = [0.0, 0.04, -0.04, 0.0, 0.0];

fn campaign() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("data")).unwrap();
    for (index, (name, crew)) in TRIALS.iter().enumerate() {
        fs::write(folder.path().join(format!("data/{name}.csv")), table(index, *crew)).unwrap();
    }
    for (file, text) in [("data/manifest.toml", MANIFEST), ("trees.toml", EXPERIMENT), ("study.toml", STUDY)] {
        fs::write(folder.path().join(file), text).unwrap();
    }
    folder
}

fn table(index: usize, crew: usize) -> String {
    let row = |k: usize| {
        let (t, phase) = (k as f64 / 10.0, index as f64);
        let q1 = 1.2 * (0.7 * t + phase).sin();
        let wind = if crew == 0 { 0.0 } else { 0.5 + 0.5 * (0.31 * t + phase).sin() };
        format!("{t},{q1},{wind},{crew},{}\n", 0.2 * q1 + 0.05 * wind + OFFSETS[crew])
    };
    std::iter::once("t,q1,wind,crew,x\n".to_string()).chain((0..200).map(row)).collect()
}

fn train(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(program()).current_dir(folder).args(arguments).assert().success().get_output().clone();
    String::from_utf8(output.stdout).unwrap()
}

fn learn(folder: &Path, out: &str, arguments: &[&str]) -> (Vec<RunRecord>, String) {
    let table = train(folder, &[&["--config", "trees.toml", "--out", out][..], arguments].concat());
    (read_records(&folder.join(out)).unwrap(), table)
}

#[test]
fn a_name_of_the_trial_is_dropped_and_a_useful_input_stays() {
    let folder = campaign();
    let (records, table) = learn(folder.path(), "run", &[]);
    let made = "one crew left out at a time (3 folds)";
    for (record, left_out) in records.iter().zip([["d1", "d4"], ["d2", "d5"], ["d3", "d6"]]) {
        assert_eq!(record.channels, ["wind"]);
        assert_eq!(record.experiment.inputs.chosen_from.as_ref().unwrap(), &["q1", "wind", "crew"]);
        assert_eq!(record.folds.as_ref().unwrap().made, made);
        assert_eq!(record.split.validation, left_out, "each seed takes another fold");
        assert_eq!(record.data.constant.get("crew"), Some(&3));
    }
    assert!(table.contains(made) && table.contains("chosen"), "{table}");
    // All inputs, then without one of three, then without one of two.
    let (study, inner) = read(&folder.path().join("run/inputs")).unwrap();
    assert_eq!(study.members.len(), 1 + 3 + 2);
    for record in inner.iter().flatten() {
        assert!(record.held_out.is_none() && record.split.held_out.is_empty(), "held-out trials were read to choose");
        assert_eq!((record.stage != Stage::Final, record.seed), (true, 1));
    }
}

/// The same with a trial of every crew in training: the name helps, and stays. So it is the folds that drop it.
#[test]
fn folds_by_trial_take_the_name_for_a_useful_input() {
    let folder = campaign();
    let (records, table) = learn(folder.path(), "run", &["--set", "protocol.leave_out=trial"]);
    assert!(records[0].channels.contains(&"crew".to_string()), "{:?}", records[0].channels);
    assert!(table.contains("constant within trials is crew (3 values)"), "{table}");
}

/// Nothing is computed twice, and what was chosen stays chosen.
#[test]
fn a_run_goes_on_with_the_inputs_that_were_chosen() {
    let folder = campaign();
    let (_, first) = learn(folder.path(), "run", &[]);
    let inner = folder.path().join("run/inputs/study.json");
    let before = fs::read(&inner).unwrap();
    fs::remove_file(folder.path().join("run/records/final-seed2.json")).unwrap();
    let (records, second) = learn(folder.path(), "run", &["--resume"]);
    assert_eq!((records.len(), first), (3, second));
    assert_eq!(before, fs::read(&inner).unwrap());
    let resolved = fs::read_to_string(folder.path().join("run/experiment.toml")).unwrap();
    assert!(resolved.contains("channels = [\"wind\"]") && !resolved.contains("select"), "{resolved}");
}

#[test]
fn a_study_chooses_as_a_run_does() {
    let folder = campaign();
    let table = train(folder.path(), &["--config", "study.toml", "--out", "study"]);
    let (study, records) = read(&folder.path().join("study")).unwrap();
    let runs: Vec<_> = study
        .members
        .iter()
        .zip(&records)
        .map(|(member, records)| acm_train::schedule::study::record::Runs { member, records })
        .collect();
    let steps = steps::steps("trees", &runs);
    let chosen: Vec<&[String]> = steps.iter().filter(|s| s.chosen).map(|s| s.set.inputs.as_slice()).collect();
    assert_eq!(chosen, [["wind".to_string()]]);
    assert!(table.contains("chosen"), "{table}");
}

#[test]
fn blocks_of_time_and_each_value_are_left_out_where_that_is_asked_for() {
    let folder = campaign();
    let asked = ["--set", "inputs.select=false", "--set"];
    let (records, _) = learn(folder.path(), "blocks", &[&asked[..], &["protocol.leave_out=block"]].concat());
    assert_eq!(records[1].split.validation[0], "d1:block2");
    assert_eq!((records[1].split.validation.len(), records[1].split.training.len()), (6, 24));
    let samples: usize =
        records[1].data.trials.iter().filter(|(name, _)| name.starts_with("d1:")).map(|t| t.1.samples).sum();
    assert_eq!(samples, 200);
    let (records, _) = learn(folder.path(), "crew", &[&asked[..], &["protocol.leave_out=crew"]].concat());
    assert_eq!(records[2].split.validation, ["d3", "d6"]);
    let refused = Command::new(program())
        .current_dir(folder.path())
        .args(["--config", "trees.toml", "--out", "wind", "--set", "protocol.leave_out=wind"])
        .assert()
        .code(2);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("protocol.leave_out") && told.contains("constant within trials"), "{told}");
}
