//! What a person gets wrong: each case with its exit code and what the message must say. No message is a panic.

mod campaign;

use std::{fs, path::Path};

use campaign::{Campaign, EXPERIMENT, MANIFEST};

/// Runs the experiment text; what is wrong with exit code or message, if anything.
fn complaint(campaign: &Campaign, text: &str, arguments: &[&str], code: i32, parts: &[&str]) -> Option<String> {
    campaign.write("tiny.toml", text);
    let output = campaign.command(arguments).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    let missing: Vec<&&str> = parts.iter().filter(|part| !message.contains(**part)).collect();
    let fine = output.status.code() == Some(code) && missing.is_empty() && !message.contains("panicked");
    (!fine)
        .then(|| format!("{arguments:?}: exit {:?} for {code}, without {missing:?}\n{message}", output.status.code()))
}

#[track_caller]
fn refuses(campaign: &Campaign, text: &str, arguments: &[&str], code: i32, parts: &[&str]) {
    if let Some(wrong) = complaint(campaign, text, arguments, code, parts) {
        panic!("{wrong}");
    }
}

#[test]
fn experiment_files() {
    let campaign = Campaign::new();
    let cases: &[(&str, &str, &[&str])] = &[
        ("[network]", "[network]\nunist = 4", &["tiny.toml:13:1", "unist", "unknown field", "units", "remove the key"]),
        ("[windows]", "[windows]\nlenght = 4", &["tiny.toml:9:1", "lenght", "unknown field", "`length`"]),
        ("[windows]", "[window]", &["tiny.toml:8:2", "window", "unknown field", "`windows`"]),
        ("length = 5", "length = -5", &["tiny.toml:9:1", "windows.length", "-5", "whole number"]),
        ("length = 5", "length = \"5\"", &["tiny.toml:9:1", "windows.length", "\"5\"", "whole number"]),
        ("length = 5", "length = 0", &["tiny.toml:9:1", "windows.length", "is 0", "from 1 to 1000000"]),
        ("reach  = 5", "reach = 4", &["windows.reach", "is 4", "windows.length = 5"]),
        ("reach  = 5", "reach = 5\nmax_gap = nan", &["tiny.toml:11:1", "windows.max_gap", "finite"]),
        ("reach  = 5", "reach = 5\nmax_gap = -inf", &["windows.max_gap", "finite"]),
        ("reach  = 5", "reach = 5\nmax_gap = -0.5", &["windows.max_gap", "-0.5", "above 0"]),
        ("units = 4", "units = 0", &["tiny.toml:14:1", "units", "0"]),
        ("units = 4", "units = 1.5", &["tiny.toml:14:1", "network.units", "1.5", "whole number"]),
        ("kind  = \"gru\"", "kind = \"lstm\"", &["tiny.toml:13:1", "network.kind", "lstm", "cfc"]),
        ("epochs = 3", "epochs = 0", &["tiny.toml:17:1", "epochs", "0"]),
        ("epochs = 3", "epochs = 3\nlearning_rate = inf", &["training.learning_rate", "finite"]),
        ("epochs = 3", "epochs = 3\nlearning_rate = -1e-3", &["training.learning_rate", "-0.001"]),
        ("seeds = [1, 2]", "seeds = []", &["tiny.toml:21:1", "protocol.seeds", "empty", "seeds = [1]"]),
        ("seeds = [1, 2]", "seeds = [1, 1]", &["protocol.seeds", "seed 1 twice"]),
        ("seeds = [1, 2]", "seeds = [1, -2]", &["protocol.seeds", "-2", "whole number"]),
        ("seeds = [1, 2]", "folds = [[\"d1\"], [\"d9\"]]", &["tiny.toml:21", "fold 1", "d9", "d1, d2, d3"]),
        ("seeds = [1, 2]", "folds = [[\"h1\"]]", &["fold 0", "h1", "d1, d2, d3"]),
        ("seeds = [1, 2]", "validation_fold = 7", &["protocol.validation_fold", "7", "3 folds", "0 to 2"]),
        ("seeds = [1, 2]", "final = false", &["protocol.final", "nothing to run"]),
        ("domain_filter = \"none\"", "domain_filter = \"sphere\"", &["inputs.domain_filter", "sphere", "hull"]),
        ("domain_filter = \"none\"", "channels = [\"q1\", \"q7\"]", &["inputs.channels", "q7", "q2"]),
        ("domain_filter = \"none\"", "channels = []", &["inputs.channels", "empty"]),
        ("domain_filter = \"none\"", "learn_from = [\"held_out\"]", &["inputs.learn_from", "held_out"]),
        ("data     = \"data\"", "data = \"no-such-folder\"", &["tiny.toml:3:1", "no-such-folder", "manifest.toml"]),
        ("data     = \"data\"", "data = \"data\"\ndevice = \"abacus\"", &["tiny.toml:4:1", "abacus", "flex"]),
        ("[protocol]", "[nominal]\nmodel = \"strain\"\n[protocol]", &["nominal.model", "strain", "[arm]"]),
        ("[protocol]", "[nominal]\nmodel = \"predicted\"\n[protocol]", &["nominal.model", "[[predicted]]"]),
        ("[protocol]", "[nominal]\nmodel = \"magic\"\n[protocol]", &["tiny.toml:21:1", "nominal.model", "magic"]),
        ("[protocol]", "[protocol", &["tiny.toml:20:1"]),
        ("length = 5\nreach  = 5", "length = 95\nreach = 95", &["95", "windows"]),
    ];
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(from, to, parts)| {
            assert!(EXPERIMENT.contains(from), "{from}");
            complaint(&campaign, &EXPERIMENT.replace(from, to), &[], 2, parts)
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(!campaign.path("runs/tiny/records").exists(), "something was run");
}

#[test]
fn edits_of_the_command_line() {
    let campaign = Campaign::new();
    let cases: &[(&str, &[&str])] = &[
        ("training.epochs", &["--set", "training.epochs", "key=value"]),
        ("training.epochs=many", &["--set", "training.epochs", "whole number"]),
        ("training.epochs=3 or 4", &["--set", "training.epochs", "\"3 or 4\"", "whole number"]),
        ("training.learning_rate=1,5", &["--set", "training.learning_rate", "\"1,5\"", "expected a number"]),
        ("training.epochs=../3", &["--set", "training.epochs", "\"../3\"", "whole number"]),
        ("protocol.seeds=[1, 2", &["--set", "`[1, 2` is not a TOML value", "[1, 2]"]),
        ("question=\"Why", &["--set", "is not a TOML value"]),
        ("data=", &["--set data=", "`` is not a TOML value"]),
        ("two words=3", &["--set", "`two words` is no dotted key"]),
        ("out=runs/x", &["--set out=runs/x", "`out` is an option", "write --out runs/x"]),
        ("data=~/nowhere", &["--set data=~/nowhere", "\"~/nowhere\", and there is no such folder"]),
        ("data=C:\\my\\robot", &["--set", "no such folder"]),
        ("network.kind=../gru", &["--set", "unknown variant `../gru`"]),
        ("protocol.seeds=2026-11-03", &["--set", "protocol.seeds"]),
        ("training.epochs=\"many\"", &["--set training.epochs=\"many\"", "training.epochs", "whole number"]),
        ("training.epoch=3", &["--set training.epoch=3", "unknown field", "epochs"]),
        ("window.length=3", &["--set window.length=3", "unknown field `window`", "did you mean `windows`"]),
        ("windows.max_gap=nan", &["--set windows.max_gap=nan", "finite"]),
        ("windows.length=-1", &["--set windows.length=-1", "windows.length"]),
        ("protocol.seeds=[]", &["--set protocol.seeds=[]", "empty"]),
        ("question.text=1", &["--set question.text=1", "question"]),
    ];
    for (edit, parts) in cases {
        refuses(&campaign, EXPERIMENT, &["--set", edit], 2, parts);
    }
}

/// A shell takes quotes away, and puts no home in behind `data=`.
#[test]
fn what_is_no_toml_value_is_a_text() {
    use acm_train::config::{find_folder, read};
    let campaign = Campaign::new();
    let with = |edit: &str| read(&campaign.path("tiny.toml"), &[edit.to_string()]).unwrap().0;
    let place = campaign.path("data").display().to_string();
    let folders = [
        &*place,
        "../x",
        "~/x",
        ".",
        "my robot",
        "C:\\my\\robot",
        "2026-11-03",
        "7",
        "1e5",
        "true",
        "a#b",
        "été",
        "x=y",
    ];
    for folder in folders {
        assert_eq!(with(&format!("data={folder}")).data, Path::new(folder), "{folder}");
    }
    assert_eq!(with("data = ../x ").data, Path::new("../x"));
    assert_eq!(with("data=\"../x\"").data, Path::new("../x"));
    assert_eq!(with("question=Why so late, after all?").question, "Why so late, after all?");
    assert_eq!(with("network.kind=cfc").network.kind(), "cfc");
    assert_eq!(with("protocol.held_out=[\"7\"]").protocol.held_out.unwrap(), ["7"]);
    let home = std::env::home_dir().expect("a home");
    assert_eq!(find_folder(Path::new("~"), Path::new("")), Some(home.join("")));
}

#[test]
fn data_are_found_wherever_the_command_line_says() {
    let campaign = Campaign::new();
    campaign.write("elsewhere.toml", &EXPERIMENT.replace("\"data\"", "\"nowhere\""));
    let home = campaign.folder.path().parent().unwrap();
    let below = campaign.folder.path().file_name().unwrap().to_string_lossy().into_owned();
    let place = campaign.path("data").display().to_string();
    for (k, folder) in [place, format!("../{below}/data"), format!("~/{below}/data")].into_iter().enumerate() {
        let mut command = campaign.program();
        command.env("HOME", home).args(["--config", "elsewhere.toml", "--set", "training.epochs=1"]);
        command.args(["--out", &format!("run{k}"), "--set", &format!("data={folder}")]).assert().success();
    }
}

#[test]
fn files_that_are_no_experiment() {
    let campaign = Campaign::new();
    let missing = campaign.program().args(["--config", "nothing.toml"]).output().unwrap();
    assert_eq!(missing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&missing.stderr).contains("nothing.toml"));
    fs::write(campaign.path("big.toml"), "# ".repeat(40_000)).unwrap();
    let big = campaign.program().args(["--config", "big.toml"]).output().unwrap();
    assert_eq!(big.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&big.stderr).contains("65536 bytes"));
    fs::write(campaign.path("binary.toml"), [b'a', 0xff, 0xfe]).unwrap();
    let binary = campaign.program().args(["--config", "binary.toml"]).output().unwrap();
    assert_eq!(binary.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&binary.stderr).contains("UTF-8"));
    let unknown = campaign.command(&["--sede", "1"]).output().unwrap();
    assert_eq!(unknown.status.code(), Some(2));
}

#[test]
fn data_that_cannot_be_used() {
    let campaign = Campaign::new();
    let table = String::from_utf8(campaign.read("data/d2.csv")).unwrap();
    campaign.write("data/d2.csv", &table.replacen("0.2,", "zero,", 1));
    refuses(&campaign, EXPERIMENT, &[], 3, &["d2.csv", "zero", "`t`"]);
    campaign.write("data/d2.csv", &table);
    campaign.write("data/manifest.toml", &MANIFEST.replace("[[\"d1\"]", "[[\"d8\"]"));
    refuses(&campaign, EXPERIMENT, &[], 3, &["manifest.toml", "d8"]);
    campaign.write("data/manifest.toml", &MANIFEST.replace("unit   = \"rad\"", "unit = \"radish\""));
    refuses(&campaign, EXPERIMENT, &[], 2, &["manifest.toml", "radish", "rad"]);
    campaign.write("data/manifest.toml", MANIFEST);
    refuses(&campaign, EXPERIMENT, &["--data", "elsewhere"], 3, &["elsewhere"]);
}

#[test]
fn folders_that_cannot_be_written() {
    let campaign = Campaign::new();
    refuses(&campaign, EXPERIMENT, &["--out", "tiny.toml/run"], 4, &["tiny.toml/run", "--out DIR"]);
    fs::create_dir(campaign.path("thesis")).unwrap();
    campaign.write("thesis/chapter1.tex", "");
    refuses(&campaign, EXPERIMENT, &["--out", "thesis"], 2, &["thesis", "not a run folder", "--out DIR"]);
}

/// The shell limits the size of files to 4 kB, so that a write fails as on a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing() {
    let campaign = Campaign::new();
    let program = assert_cmd::cargo::cargo_bin!("acm-train");
    let script = format!("ulimit -f 4; exec '{}' --config tiny.toml", program.display());
    let output =
        std::process::Command::new("sh").args(["-c", &script]).current_dir(campaign.folder.path()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.contains("cannot write") && message.contains("--resume"), "{message}");
    campaign.learn("runs/tiny", &["--resume"]);
}
