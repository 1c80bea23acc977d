//! `acm-eval export` and `acm-eval import` on a run that is trained here.
//!
//! Oracles: the test that each export leaves, run by gcc, torch and ONNX Runtime where they are there (`ACM_PYTHON` names the
//! interpreter); the scores that a network had before it left; the errors that torch finds of a network that it has trained.

#[allow(dead_code)]
mod formulas;

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use acm_datasets::Campaign;
use acm_train::run::nominal::augmented;
use acm_train::run::record::{RunRecord, read_records};
use acm_train::store::hashed;
use formulas::{Robot, TRIALS, self_test, table};
use serde_json::Value;

/// What a script returns where a package is missing.
const SKIPPED: i32 = 77;

/// Edits of an experiment whose network is added in part.
const FACTOR: &[&str] = &["nominal.model=none", "training.output_layer=zero", "training.learning_rate=1e-2"];

fn python(script: &Path, arguments: &[&Path]) -> Option<Output> {
    let python = std::env::var("ACM_PYTHON").unwrap_or_else(|_| "python3".into());
    let Ok(output) = Command::new(&python).arg(script).args(arguments).output() else {
        eprintln!("skipped: {python} is not installed");
        return None;
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    println!("{}: {}", script.display(), said.trim());
    if output.status.code() == Some(SKIPPED) {
        eprintln!("{}: {}", script.display(), said.trim());
        return None;
    }
    Some(output)
}

fn lines(text: &str) -> Vec<&str> {
    text.lines().collect()
}

#[test]
fn all_three_agree_with_the_estimator() {
    let cfc = [FACTOR, &["network.kind=cfc"][..]].concat();
    for (augmented, edits) in [(true, &["network.kind=gru", "training.ensemble=2"][..]), (false, &cfc[..])] {
        let robot = Robot::new();
        robot.save_model();
        let record = robot.learn_with(augmented, edits).remove(0);
        assert!(record.factor > 0.0, "a network that says something");
        let arguments =
            ["run", "--c99", "c", "--onnx", "onnx", "--torch", "torch", "--name", "arm", "--recorded", "500"];
        let (code, printed, told) = robot.ask("export", &arguments, "");
        assert_eq!(code, 0, "{told}");
        let expected = [
            "c/arm.h",
            "c/arm.c",
            "onnx/arm.onnx",
            "onnx/arm_onnx.json",
            "onnx/arm_onnx_check.py",
            "torch/arm.safetensors",
            "torch/arm_torch.json",
            "torch/arm_torch.py",
        ];
        assert_eq!(lines(&printed), expected);
        self_test(&robot.path("c"), "arm");
        let header = fs::read_to_string(robot.path("c/arm.h")).unwrap();
        for line in [
            "ARM_ACTUATOR_Q1 = 0, /* q1: rad (manifest: deg; a value in deg times 0.017453292519943295 is SI) */",
            "/* wind, column w: 1 (manifest: %; a value in % times 0.01 is SI) */",
            "ARM_OUTPUT_Y = 1, /* y: m (manifest: mm; a value in mm times 0.001 is SI) */",
        ] {
            assert!(header.contains(line), "{line}: {header}");
        }
        for script in ["onnx/arm_onnx_check.py", "torch/arm_torch.py"] {
            let Some(output) = python(&robot.path(script), &[]) else { continue };
            assert!(output.status.success(), "{script}");
            assert!(String::from_utf8_lossy(&output.stdout).starts_with("500 steps: outputs within"));
        }
        // A file that stream saved exports to the same bytes, but for where it came from.
        assert_eq!(robot.stream(&["run", "--save", "robot.json"], "").0, 0);
        let arguments = ["robot.json", "--torch", "again", "--name", "arm"];
        assert_eq!(robot.ask("export", &arguments, "").0, 0);
        let read = |name: &str| fs::read(robot.path(name)).unwrap();
        assert_eq!(read("torch/arm.safetensors"), read("again/arm.safetensors"));
    }
}

/// The model of a closed loop, by its folder and by itself: dead time, play and lag, without a network.
#[test]
fn the_model_of_a_closed_loop_leaves_as_c() {
    let robot = Robot::new();
    robot.save_model();
    let data = Campaign::read(&robot.path("data"), None).unwrap();
    let model = augmented::read(&robot.path("model.json")).unwrap();
    let origin = augmented::origin(&model, &data);
    fs::create_dir(robot.path("loop")).unwrap();
    robot.write("loop/loop.json", "{\"verdict\": \"named\", \"effects\": []}");
    let model = String::from_utf8(hashed::encode(&model.with_origin(origin)).unwrap()).unwrap();
    robot.write("loop/model.json", &model);
    for (given, c) in [("loop", "c1"), ("loop/model.json", "c2"), ("model.json", "c3")] {
        let (code, printed, told) = robot.ask("export", &[given, "--c99", c, "--name", "arm"], "");
        assert_eq!((code, lines(&printed).len()), (0, 2), "{told}");
        self_test(&robot.path(c), "arm");
    }
    let header = fs::read_to_string(robot.path("c1/arm.h")).unwrap();
    for line in [
        "ARM_ACTUATOR_Q2 = 1, /* q2: rad (manifest: deg; a value in deg times 0.017453292519943295 is SI) */",
        "ARM_CONTEXT_WIND = 2, /* wind: 1 (manifest: %; a value in % times 0.01 is SI) */",
        "ARM_OUTPUT_X = 0, /* x: m (manifest: mm; a value in mm times 0.001 is SI) */",
        "network  none",
    ] {
        assert!(header.contains(line), "{line}: {header}");
    }
    let (code, _, told) = robot.ask("export", &["loop", "--onnx", "out"], "");
    assert!(code == 2 && told.contains("without a network") && told.contains("--c99 DIR"), "{told}");
    let (code, _, told) = robot.stream(&["loop", "--save", "robot.json"], "");
    assert!(code == 2 && told.contains("acm-eval export loop --c99 DIR"), "{told}");
    let (code, _, told) = robot.stream(&["model.json"], "");
    assert!(code == 2 && told.contains("acm-eval export model.json --c99 DIR"), "{told}");
    fs::rename(robot.path("loop/model.json"), robot.path("loop/refuted.json")).unwrap();
    let (code, _, told) = robot.ask("export", &["loop", "--c99", "c4"], "");
    assert!(code == 2 && told.contains("loop/refuted.json itself") && !robot.path("c4").exists(), "{told}");
    assert_eq!(robot.ask("export", &["loop/refuted.json", "--c99", "c4"], "").0, 0);
}

/// Recordings, records and sources stay; what an export or `--save` wrote is replaced.
#[test]
fn nothing_of_others_is_replaced() {
    let robot = Robot::new();
    robot.learn_with(false, &["training.epochs=1"]);
    for file in ["data/c1.csv", "data/manifest.toml", "run/records/final-seed1.json", "run/nominal.json", "gru.toml"] {
        let before = fs::read(robot.path(file)).unwrap();
        let (code, _, told) = robot.stream(&["run", "--save", file], "");
        assert!(code == 2 && told.contains(file) && told.contains("another name"), "{file}: {code}: {told}");
        assert_eq!(fs::read(robot.path(file)).unwrap(), before, "{file}");
    }
    for format in ["--c99", "--onnx", "--torch"] {
        let (code, _, told) = robot.ask("export", &["run", format, "data"], "");
        assert!(code == 2 && told.contains("data is a data set"), "{format}: {told}");
    }
    assert_eq!(fs::read_dir(robot.path("data")).unwrap().count(), TRIALS.len() + 1);
    let exports = [
        ("--c99", "estimator.c"),
        ("--onnx", "estimator.onnx"),
        ("--onnx", "estimator_onnx.json"),
        ("--onnx", "estimator_onnx_check.py"),
        ("--torch", "estimator.safetensors"),
        ("--torch", "estimator_torch.json"),
        ("--torch", "estimator_torch.py"),
    ];
    for (k, (format, file)) in exports.into_iter().enumerate() {
        let folder = format!("mine{k}");
        fs::create_dir(robot.path(&folder)).unwrap();
        robot.write(&format!("{folder}/{file}"), "of somebody\n");
        let (code, _, told) = robot.ask("export", &["run", format, &folder], "");
        assert!(code == 2 && told.contains(file) && told.contains("another name"), "{file}: {code}: {told}");
        assert_eq!(fs::read_dir(robot.path(&folder)).unwrap().count(), 1, "{file}");
    }
    for _ in 0..2 {
        assert_eq!(robot.stream(&["run", "--save", "robot.json"], "").0, 0);
        let (code, _, told) = robot.ask("export", &["run", "--c99", "out", "--onnx", "out", "--torch", "out"], "");
        assert_eq!(code, 0, "{told}");
    }
}

#[test]
fn what_cannot_leave_is_refused_by_name() {
    let robot = Robot::new();
    robot.learn_with(false, &["training.epochs=1"]);
    for (arguments, expected, part) in [
        (vec!["run"], 2, "--c99"),
        (vec!["run", "--c99", "out", "--name", "9lives"], 2, "no name for files"),
        (vec!["nowhere", "--c99", "out"], 4, "no such folder"),
        (vec!["gru.toml", "--c99", "out"], 3, "gru.toml"),
        (
            vec!["gru.toml", "--c99", "out"],
            3,
            "give a run folder, a file of `acm-eval stream RUN --save FILE`, or the model.json",
        ),
        (vec!["run/nominal.json", "--c99", "out"], 3, "neither an estimator nor a model"),
        (vec!["gru.toml", "--c99", "out", "--network", "final-seed1"], 2, "leave --network out"),
        (vec!["run", "--c99", "out", "--recorded", "0"], 2, "recorded"),
    ] {
        let (code, _, told) = robot.ask("export", &arguments, "");
        assert!(code == expected && told.contains(part), "{arguments:?}: {code}: {told}");
    }
}

fn record(robot: &Robot, run: &str) -> RunRecord {
    read_records(&robot.path(run)).unwrap().remove(0)
}

/// Oracle: the scores before the network left, bit for bit: the scalers are the same, and so is what computes.
#[test]
fn a_network_comes_back_as_it_left() {
    for (kind, network) in [
        ("gru", "network={kind = \"gru\", units = 5, layers = 2}"),
        ("cfc", "network={kind = \"cfc\", units = 5}"),
        ("mlp", "network={kind = \"mlp\", hidden = [7, 4]}"),
    ] {
        let robot = Robot::new();
        robot.learn_with(false, &[network, "protocol.seeds=[1, 2]"]);
        let arguments = ["run", "--torch", "out", "--network", "final-seed2"];
        assert_eq!(robot.ask("export", &arguments, "").0, 0);
        let arguments = ["out/estimator.safetensors", "--like", "run", "--network", "final-seed2", "--out", "back"];
        let (code, printed, told) = robot.ask("import", &arguments, "");
        assert_eq!(code, 0, "{told}");
        assert!(printed.contains(kind) && printed.contains("back"), "{printed}");
        let left = read_records(&robot.path("run")).unwrap().remove(1);
        let back = record(&robot, "back");
        assert_eq!((&back.id, back.best_epoch, back.factor), (&left.id, 1, 1.0));
        assert_eq!((&back.held_out, &back.validation), (&left.held_out, &left.validation), "{kind}");
        assert_eq!(back.predictions_sha256, left.predictions_sha256, "{kind}");
        let imported = back.experiment.training.imported.unwrap();
        assert_eq!((imported.file.as_str(), imported.sha256.len()), ("estimator.safetensors", 64));
        // It is a run like any other.
        // Its interval is another: it comes from what one run left out.
        let asked = |run: &str| {
            let answers = robot.stream(&[run, "--network", "final-seed2"], table(4)).1;
            let cut = |line: &str| line.split(',').take(7).map(String::from).collect::<Vec<_>>();
            answers.lines().map(cut).collect::<Vec<_>>()
        };
        assert_eq!(asked("back"), asked("run"));
        let (code, _, told) = robot.ask("report", &["back", "--out", "page"], "");
        assert_eq!(code, 0, "{told}");
    }
}

/// A factor stands in the scalers of what leaves, and in the output layer of what comes back.
#[test]
fn a_factor_comes_back_within_single_precision() {
    for (edits, expected) in [(FACTOR, 0.5..0.9999), (&["training.output_layer=zero"][..], 0.0..1e-9)] {
        let robot = Robot::new();
        let left = robot.learn_with(false, edits).remove(0);
        assert!(expected.contains(&left.factor), "{}", left.factor);
        assert_eq!(robot.ask("export", &["run", "--torch", "out"], "").0, 0);
        let (code, _, told) = robot.ask("import", &["out/estimator.safetensors", "--like", "run", "--out", "back"], "");
        assert_eq!(code, 0, "{told}");
        let errors = |record: &RunRecord| record.held_out.as_ref().unwrap().estimators["gru"].rmse_total;
        let (before, after) = (errors(&left), errors(&record(&robot, "back")));
        assert!((before / after - 1.0).abs() < 1e-6, "{before} {after}");
    }
}

/// Oracle: the errors that torch finds on the held-out trials, with windows, rates and scalers of its own.
#[test]
fn a_network_that_torch_trained_scores_the_same() {
    let robot = Robot::new();
    let script = std::path::absolute("tests/export/train_gru.py").unwrap();
    let Some(output) = python(&script, &[&robot.path("data"), robot.folder.path()]) else { return };
    assert!(output.status.success());
    let torch: Value = serde_json::from_slice(&output.stdout).unwrap();
    let edits = ["--set", "nominal.model=none", "--set", "inputs.domain_filter=none"];
    let files: &[&str] = if cfg!(feature = "pytorch") { &["gru.safetensors", "gru.pt"] } else { &["gru.safetensors"] };
    for (k, file) in files.iter().enumerate() {
        let out = format!("run{k}");
        let (code, _, told) =
            robot.ask("import", &[&[*file, "--like", "gru.toml", "--out", &out][..], &edits[..]].concat(), "");
        assert_eq!(code, 0, "{told}");
        let score = record(&robot, &out).held_out.unwrap().estimators.remove("gru").unwrap();
        assert_eq!(torch["samples"].as_u64(), Some(score.samples as u64));
        for (o, found) in score.rmse.iter().enumerate() {
            let (right, constant) = (torch["rmse"][o].as_f64().unwrap(), torch["constant"][o].as_f64().unwrap());
            println!("output {o}: torch {right:.9} m, here {found:.9} m, a constant {constant:.3} m");
            assert!((found / right - 1.0).abs() < 1e-5, "output {o}: {found} instead of {right}");
            assert!(right < 0.7 * constant, "torch has learned something: {right} of {constant}");
        }
    }
}

#[test]
fn what_cannot_come_in_is_refused_by_name() {
    let robot = Robot::new();
    robot.learn(false);
    assert_eq!(robot.ask("export", &["run", "--torch", "out"], "").0, 0);
    let about = fs::read_to_string(robot.path("out/estimator_torch.json")).unwrap();
    let other = |name: &str, from: &str, to: &str| {
        let changed = about.replacen(from, to, 1);
        assert_ne!(changed, about);
        robot.write(name, &changed);
    };
    other("units.json", "\"units\": 5", "\"units\": 6");
    other("kind.json", "\"kind\": \"gru\"", "\"kind\": \"lstm\"");
    other("signal.json", "\"signal\": \"q1\"", "\"signal\": \"q9\"");
    other("scaler.json", "\"spread\": [", "\"spread\": [\n 1.0,");
    robot.write("broken.safetensors", "laps");
    robot.write("gru.pt", "laps");
    let file = "out/estimator.safetensors";
    for (arguments, expected, part) in [
        (
            vec![file, "--like", "run", "--about", "units.json"],
            3,
            "rnn.weight_ih_l0 is [15, 3], and the network needs [18, 3]",
        ),
        (vec![file, "--like", "run", "--about", "kind.json"], 3, "lstm"),
        (vec![file, "--like", "run", "--about", "signal.json"], 2, "q9"),
        (vec![file, "--like", "run", "--about", "scaler.json"], 3, "the scaler of the inputs needs 3"),
        (vec![file, "--like", "run", "--about", "nowhere.json"], 4, "nowhere.json"),
        (vec![file, "--like", "run", "--network", "final-seed9"], 2, "no network \"final-seed9\""),
        (vec![file, "--like", "gru.toml", "--network", "final-seed1"], 2, "one of a run folder"),
        (vec![file, "--like", "data"], 2, "not a run folder"),
        (vec![file, "--like", "run", "--out", "run"], 2, "run"),
        (vec![file, "--like", "gru.toml", "--set", "inputs.select=true"], 2, "inputs.select"),
        (vec!["broken.safetensors", "--like", "run"], 3, "save_file(module.state_dict(), FILE)"),
        (vec!["nowhere.safetensors", "--like", "run"], 4, "nowhere.safetensors"),
    ] {
        let out = if arguments.contains(&"--out") { vec![] } else { vec!["--out", "back"] };
        let (code, _, told) = robot.ask("import", &[arguments.clone(), out].concat(), "");
        assert!(code == expected && told.contains(part), "{arguments:?}: {code}: {told}");
        assert!(!robot.path("back").exists(), "{arguments:?}");
    }
    if !cfg!(feature = "pytorch") {
        let (code, _, told) = robot.ask("import", &["gru.pt", "--like", "run", "--out", "back"], "");
        assert!(code == 2 && told.contains("--features pytorch"), "{code}: {told}");
    }
    // Nothing is trained where a checkpoint is lost.
    assert_eq!(robot.ask("import", &[file, "--like", "run", "--out", "back"], "").0, 0);
    fs::remove_file(robot.path("back/checkpoints/final-seed1.safetensors")).unwrap();
    fs::remove_file(robot.path("back/records/final-seed1.json")).unwrap();
    let (experiment, source) = acm_train::config::read(&robot.path("back/experiment.toml"), &[]).unwrap();
    let (out, progress, stop) = (robot.path("back"), acm_train::run::progress::Progress::Quiet, Default::default());
    let request = acm_train::schedule::request::Request::new(&out, &progress, &stop);
    let request = acm_train::schedule::request::Request { resume: true, ..request };
    let refused = acm_train::schedule::job::run(experiment, &source, &request).unwrap_err().to_string();
    assert!(refused.contains("its checkpoint is missing"), "{refused}");
}
